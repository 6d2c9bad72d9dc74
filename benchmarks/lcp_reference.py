"""Judges answers to linear complementarity problems, from M and q alone.

Nothing that a solver says about itself is trusted: residuals and certificates are computed anew in
extended precision, and where the making of a problem does not tell its answer, HiGHS does.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum

import highspy
import numpy as np

from drystone import lcp
from lcp_families import Array, Problem

RESIDUAL = 1e-9
"""What "solved" promises: the largest |min(z, w)| in the problem's own scale (`lcp.Solution`)."""

RISE = 2e-12
"""A certificate's largest M'y, for y with the largest entry 1 and M with a unit diagonal."""

PROGRESS = 5e-8
"""The least -q'y of a certificate, with y's sum and q's largest entry 1. For `M = G'G`, `q = -G'h`,
which have a solution, rounding in M's last digits can show as 1e-8 here."""

NOISE = 1e-13
"""A least eigenvalue (unit diagonal) below minus this: M is indefinite, and Lemke's method may end
on a ray that proves nothing, as its page says."""

CLEAR = (1e-8, 1e-5)
"""HiGHS's least lift of all w, with q's largest entry 1: below the first there is a solution, above
the other there is none."""


class Judgement(Enum):
    """What an answer is worth."""

    RIGHT = "right"
    UNANSWERED = "unanswered"
    WRONG = "wrong"


@dataclass(frozen=True)
class Verdict:
    """The judgement on one answer, and the reason where it is not right."""

    judgement: Judgement
    reason: str = ""


def judge(problem: Problem, answer: lcp.Solution | lcp.LcpError) -> Verdict:
    """Compare one answer with what is expected, if anything is, and with its own proof."""
    if isinstance(answer, lcp.LcpError):
        return _judge_refusal(problem, answer)
    if answer.status == "solved":
        flaw = _flaw_of_solution(problem, answer.z)
    elif answer.status == "no_solution":
        flaw = _flaw_of_certificate(problem, answer.ray)
    elif (
        answer.status == "ray_termination"
        and problem.rounded
        and _least_eigenvalue(problem) < -NOISE
    ):
        return Verdict(Judgement.RIGHT)
    else:
        return Verdict(Judgement.UNANSWERED, f"{answer.status}, residual {answer.residual:.1e}")
    if flaw:
        return Verdict(Judgement.WRONG, f"{answer.status}, but {flaw}")
    if problem.expected not in (None, answer.status):
        size = np.max(_scaled(problem)[3] * answer.z, initial=0.0)
        return Verdict(
            Judgement.WRONG, f"{answer.status} instead of {problem.expected}, z {size:.0e} of q"
        )
    return Verdict(Judgement.RIGHT)


def _scaled(problem: Problem) -> tuple[Array, Array, Array, Array]:
    """M with a unit diagonal, q with largest entry 1, and what y and z are multiplied by."""
    diagonal = problem.M.diagonal()
    d = 1 / np.sqrt(np.where(diagonal > 0, diagonal, 1.0)).astype(np.longdouble)
    q = d * problem.q
    size = np.max(np.abs(q), initial=0.0) or np.longdouble(1)
    return (d * problem.M) * d[:, None], q / size, 1 / d, 1 / (d * size)


def _flaw_of_solution(problem: Problem, z: Array) -> str:
    M, q, _, unit = _scaled(problem)
    z = unit * z
    if not np.all(np.isfinite(z)) or np.any(z < 0):
        return "z is negative or not finite"
    worst, size = np.max(np.abs(np.minimum(z, M @ z + q)), initial=0.0), np.max(z, initial=1.0)
    return f"the residual is {worst / size:.1e}" if worst > 1.01 * RESIDUAL * size else ""


def _flaw_of_certificate(problem: Problem, y: Array | None) -> str:
    if y is None or not np.all(np.isfinite(y)) or np.any(y < 0) or not np.any(y > 0):
        return "there is no certificate"
    M, q, unit, _ = _scaled(problem)
    y = unit * y
    y /= y.max()
    rise, progress = np.max(M.T @ y), -(q @ y) / y.sum()
    if rise > RISE or progress < PROGRESS:
        return f"M'y reaches {rise:.1e} and q'y is {-progress:.1e}"
    return ""


def _judge_refusal(problem: Problem, error: lcp.LcpError) -> Verdict:
    """Right is only "not semidefinite", with an eigenvalue that M has."""
    least = _least_eigenvalue(problem)
    named = _named_eigenvalue(error)
    if not problem.rounded or "semidefinite" not in str(error):
        return Verdict(Judgement.WRONG, f"refused: {error}")
    if named is not None and not 1.06 * least - 1e-15 <= named < 0:
        return Verdict(Judgement.WRONG, f"the least eigenvalue is {least:.1e}, not {named:.1e}")
    return Verdict(Judgement.RIGHT)


def _least_eigenvalue(problem: Problem) -> float:
    return float(np.linalg.eigvalsh(_scaled(problem)[0].astype(float))[0])


def _named_eigenvalue(error: lcp.LcpError) -> float | None:
    found = re.search(r"eigenvalue of (\S+)", str(error))
    return float(found[1]) if found else None


def reference(problem: Problem) -> str | None:
    """The answer for a semidefinite M by HiGHS: it is solvable if `M z + q >= 0`, `z >= 0` is.

    The least s with `M z + q + s >= 0` is also the largest progress of any certificate y of sum 1.
    """
    M, q, _, _ = (np.asarray(part, dtype=float) for part in _scaled(problem))
    n = len(q)
    highs = highspy.Highs()
    highs.silent()
    # HiGHS keeps the number of threads of its first run in a process.
    highs.setOptionValue("threads", 1)
    for name in ("primal_feasibility_tolerance", "dual_feasibility_tolerance"):
        highs.setOptionValue(name, 1e-10)
    program = highspy.HighsLp()
    program.num_col_, program.num_row_ = n + 1, n
    program.col_cost_ = np.append(np.zeros(n), 1.0)
    program.col_lower_, program.col_upper_ = np.zeros(n + 1), np.full(n + 1, highspy.kHighsInf)
    program.row_lower_, program.row_upper_ = -q, np.full(n, highspy.kHighsInf)
    program.a_matrix_.format_ = highspy.MatrixFormat.kRowwise
    program.a_matrix_.start_ = np.arange(n + 1) * (n + 1)
    program.a_matrix_.index_ = np.tile(np.arange(n + 1), n)
    program.a_matrix_.value_ = np.column_stack([M, np.ones(n)]).ravel()
    highs.passModel(program)
    highs.run()
    if highs.getModelStatus() != highspy.HighsModelStatus.kOptimal:
        return None
    lift = highs.getInfo().objective_function_value
    return "solved" if lift <= CLEAR[0] else "no_solution" if lift >= CLEAR[1] else None
