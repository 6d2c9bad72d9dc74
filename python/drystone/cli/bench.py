"""`drystone bench`."""

from __future__ import annotations

from pathlib import Path

from drystone.cli.inputs import reporting_files


def run(folder: Path) -> int:
    """Print Table I and write the figures; 0 if every assembly was planned."""
    from rich.console import Console

    from drystone import paper

    console = Console(highlight=False)
    with reporting_files():
        folder.mkdir(parents=True, exist_ok=True)
        with console.status("planning") as status:
            rows = paper.measure(lambda what: status.update(f"planning {what}"))
            status.update("drawing")
            written = [paper.write_csv(rows, folder), *paper.write_figures(rows, folder)]
    for table in paper.as_tables(rows):
        console.print(table)
    for path in written:
        console.print(f"written: {path}", soft_wrap=True)
    return 0 if all(row.found for row in rows) else 1
