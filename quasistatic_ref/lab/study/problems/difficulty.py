"""How hard a problem is, in numbers, and in words that problems are chosen by."""

from typing import Any

import numpy as np

from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.lab.study.problems.problem import Problem
from quasistatic_ref.step.data import Array

TOUCHING = 1e-12
"""Slack in natural units [-] below which a row counts as active: ties that rounding splits."""
DEPENDENT = 1e-9
"""Singular value of active rows of length one [-] that counts as none."""
ILL = 1e8
"""Condition number of H in natural units from which it is called ill-conditioned."""
CLOSE = 1e-6
"""Least slack or multiplier in natural units [-] below which activity is hard to tell."""
SHOWN = 4
"""Significant figures."""


def measures(one: Problem) -> dict[str, Any]:
    """Difficulty of a problem, in natural units: numbers without a unit.

    Parameters
    ----------
    one : Problem

    Returns
    -------
    dict
        ``condition`` (in SI units), ``condition_natural``; ``row_ratio``, of the lengths of the
        rows; and, of a problem with an answer, ``active`` rows, their ``rank``, ``dependent``: how
        many are more than that; ``smallest_slack`` of the other rows, ``smallest_multiplier`` of
        those that bear, and ``size``: ||x*||_H / ||H^-1 g||_H. None: not known.
    """
    natural = one.natural
    lengths = np.sqrt(np.asarray(natural.A.multiply(natural.A).sum(axis=1)).ravel())
    positive = lengths[lengths > 0]
    numbers: dict[str, Any] = {
        "condition": float(np.linalg.cond(one.H.toarray())),
        "condition_natural": float(np.linalg.cond(natural.H.toarray())),
        "row_ratio": float(positive.max() / positive.min()) if positive.size else None,
    }
    if one.answer.farkas:
        return _rounded(numbers)
    slack = natural.answer.slack
    lam = natural.answer.lam
    reach = TOUCHING if one.answer.error == 0 else one.answer.error
    active = np.flatnonzero(slack <= reach)
    idle = np.delete(slack, active)
    bearing = lam[lam > 0]
    rank = _rank(natural, active)
    sharp = one.answer.error == 0
    norm = energy_norm(natural.H.toarray())
    free = norm.of_impulse(natural.g)
    numbers |= {
        "active": len(active),
        "rank": rank,
        "dependent": len(active) - rank,
        "smallest_slack": float(idle.min()) if sharp and idle.size else None,
        "smallest_multiplier": float(bearing.min()) if sharp and bearing.size else None,
        "size": norm.of_displacement(natural.answer.x) / free if free > 0 else None,
    }
    return _rounded(numbers)


def tags(one: Problem, numbers: dict[str, Any]) -> list[str]:
    """Words that a problem is chosen by.

    Parameters
    ----------
    one : Problem
    numbers : dict
        Its :func:`measures`.
    """
    answer = one.answer
    holding = {
        "diagonal H": not one.H.nnz > len(one.g),
        "infeasible": bool(answer.farkas),
        "trivial": not answer.farkas and not answer.x.any(),
        "dependent": bool(numbers.get("dependent")),
        "several multipliers": answer.unique is False,
        "ill-conditioned": (numbers["condition_natural"] or 0) >= ILL,
        "close call": _close(numbers),
        "penetrating": bool((one.b > 0).any()),
    }
    return [word for word, holds in holding.items() if holds]


def _close(numbers: dict[str, Any]) -> bool:
    sizes = [numbers.get("smallest_slack"), numbers.get("smallest_multiplier")]
    return any(size is not None and size < CLOSE for size in sizes)


def _rank(natural: Problem, active: np.ndarray) -> int:
    rows: Array = natural.A[active].toarray()
    lengths = np.linalg.norm(rows, axis=1, keepdims=True)
    rows = rows / np.where(lengths > 0, lengths, 1.0)
    return int(np.linalg.matrix_rank(rows, tol=DEPENDENT)) if len(rows) else 0


def _rounded(numbers: dict[str, Any]) -> dict[str, Any]:
    return {
        name: float(f"{v:.{SHOWN}g}") if isinstance(v, float) else v for name, v in numbers.items()
    }
