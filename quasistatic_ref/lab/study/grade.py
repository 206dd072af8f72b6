"""A reply as facts: what it says, its residuals, and the digits of its x."""

from typing import Any, TypeGuard

import numpy as np

from quasistatic_ref.lab.study.problems.names import RAW
from quasistatic_ref.lab.study.program import Known, Program
from quasistatic_ref.lab.study.saying import OTHER, saying
from quasistatic_ref.lab.study.solvers import Solver
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.quoting import clipped
from quasistatic_ref.solve.solver import Reply
from quasistatic_ref.solve.units import in_natural, in_si

RESIDUALS = ("primal", "dual", "gap")


def facts_of_reply(
    problem: Known, units: str, reply: Reply, solver: Solver, accuracy: float | None
) -> dict[str, Any]:
    """The fields of a study's row that grade one reply of a solver.

    Parameters
    ----------
    problem : Known
    units : str
        Of the call: ``"raw"`` or ``"natural"``.
    reply : Reply
    solver : Solver
    accuracy : float or None
        That was asked for [-].
    """
    program = problem.program
    facts = no_reply(reply.status, accuracy)
    facts["says"] = saying(solver.door, solver.target, reply.status)
    if not _is_vector(reply.x, program.g):
        return facts
    x = reply.x
    lam = reply.lam if _is_vector(reply.lam, program.b) else np.full(len(program.b), np.nan)
    with np.errstate(all="ignore"):  # the numbers of a solver may be anything
        if units == RAW:
            x, lam = in_natural(x, lam, problem.units)
        sizes = residuals(program.natural(problem.units), x, lam)
        if problem.feasible:
            facts["digits"] = problem.digits(in_si(x, lam, problem.units)[0])
    if accuracy is not None:
        facts["reached"] = all(size is not None and size <= accuracy for size in sizes.values())
    return facts | sizes


def no_reply(status: str, accuracy: float | None, seconds: float | None = None) -> dict[str, Any]:
    """The fields of a study's row for a call without an answer.

    Parameters
    ----------
    status : str
        Why there is none.
    accuracy : float or None
        That was asked for [-].
    seconds : float or None
        Until the call was ended [s].
    """
    return dict.fromkeys((*RESIDUALS, "digits")) | {
        "status": clipped(status),
        "says": OTHER,
        "reached": None if accuracy is None else False,
        "seconds": seconds,
    }


def _is_vector(returned: Array | None, like: Array) -> TypeGuard[Array]:
    """Whether a solver returned finite numbers, in the shape of another array."""
    return (
        returned is not None and returned.shape == like.shape and bool(np.isfinite(returned).all())
    )


def residuals(program: Program, x: Array, lam: Array) -> dict[str, float | None]:
    """The residuals of an answer: of the rows, of Eq. :eq:`eq-9` and signs, and of the costs.

    Those of qpbenchmark, but that a negative multiplier is a dual residual, too.

    Parameters
    ----------
    program : Program
    x, lam : ndarray, shapes (n,) and (m,)
        In the units of the program; NaN in place of multipliers that are not known [any].

    Returns
    -------
    dict
        ``primal``, ``dual`` and ``gap``; None: not known, or beyond float64.
    """
    H, g, A, b, equations = program
    slack = A @ x - b
    violation = np.append(abs(slack[:equations]), np.maximum(-slack[equations:], 0.0))
    wrong_sign = np.maximum(-lam[equations:], 0.0)
    balance = H @ x - g - A.T @ lam
    sizes = {
        "primal": violation.max(initial=0.0),
        "dual": max(abs(balance).max(initial=0.0), wrong_sign.max(initial=0.0)),
        "gap": abs(x @ H @ x - g @ x - b @ lam),
    }
    return {name: float(size) if np.isfinite(size) else None for name, size in sizes.items()}
