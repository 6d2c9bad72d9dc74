"""Results as tables."""

from __future__ import annotations

import math

from rich.console import Console
from rich.table import Table

from measure import Measured
from results import Case


def show(console: Console, case: Case) -> None:
    """All peers on one workload."""
    queries = next(iter(case.results.values())).queries
    title = f"{case.row}, {case.workload}: {case.blocks} blocks, {queries} questions"
    table = Table(title=title + (f" ({case.note})" if case.note else ""), title_justify="left")
    table.add_column("peer")
    for name in ("total ms", "/ reuse", "iterations", "missing", "wrong", "residual", "MB"):
        table.add_column(name, justify="right")
    table.add_column("")
    refused: dict[str, list[str]] = {}
    for result in case.results.values():
        if result.refused:
            refused.setdefault(result.refused, []).append(result.peer)
        else:
            table.add_row(*_cells(case, result))
    console.print(table)
    for reason, peers in refused.items():
        console.print(f"not run: {', '.join(peers)}: {reason}", highlight=False)
    console.print()


def _cells(case: Case, r: Measured) -> tuple[str, ...]:
    wrong = str(r.wrong) + ("" if r.checked == r.answered else f" of {r.checked}")
    remark = r.cut_off or (f"{r.inaccurate} residuals > 1e-9" if r.inaccurate else "")
    bound = ">" if r.cut_off else ""
    return (
        r.peer,
        f"{bound}{1e3 * r.seconds:.4g}",
        _shown(case.ratio(r), ".3g", bound),
        str(r.iterations),
        f"[red]{r.missing}[/]" if r.missing else "0",
        f"[red]{wrong}[/]" if r.wrong else wrong,
        _shown(r.residual, ".0e"),
        _shown(r.memory, ".3g"),
        remark,
    )


def _shown(value: float, style: str, before: str = "") -> str:
    return "-" if math.isnan(value) else f"{before}{value:{style}}"


def show_summary(console: Console, cases: list[Case]) -> None:
    """Reuse against the fastest other peer, workload by workload."""
    table = Table(title="drystone reuse against the fastest right peer", title_justify="left")
    for name in ("scene", "friction", "workload"):
        table.add_column(name)
    table.add_column("reuse ms", justify="right")
    table.add_column("fastest peer")
    table.add_column("its ms", justify="right")
    table.add_column("times faster", justify="right")
    table.add_column("by least times", justify="right")
    for case in cases:
        reuse, fastest = case.results.get("reuse"), case.fastest
        measured = reuse is not None and bool(reuse.times)
        table.add_row(
            case.row.scene,
            f"{case.row.friction:g}",
            case.workload,
            f"{1e3 * reuse.seconds:.4g}" if reuse is not None and measured else "-",
            fastest.peer if fastest else "none",
            f"{1e3 * fastest.seconds:.4g}" if fastest else "-",
            _shown(case.ratio(fastest), ".3g") if fastest else "-",
            _shown(case.ratio_of_least(fastest), ".3g") if fastest else "-",
        )
    console.print(table)
