"""A plain quadratic program put to a solver, and its reply as it is: not judged, not mended.

This is what studies of solvers measure. Steps of a simulation go through
:mod:`~quasistatic_ref.solve.ask`, which tries harder and believes less.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.step.data import Array, Contacts, Extra, StepData
from quasistatic_ref.step.standard_form import StandardForm


@dataclass(frozen=True, eq=False)
class Reply:
    """What came back from one call.

    Parameters
    ----------
    x : ndarray, shape (n,), or None
        The answer to min 1/2 x'Hx - g'x, A x >= b; any shape if the solver is broken.
    lam : ndarray, shape (m,), or None
        Its multipliers.
    claimed : str
        The solver's own status, or what it raised.
    said_optimal : bool
        Whether it claims to have solved the problem.
    solver_seconds : float or None
        Time of the solver by its own account [s].
    call_seconds : float
        Time of the whole call [s].
    iterations : int or None
    """

    x: Array | None
    lam: Array | None
    claimed: str
    said_optimal: bool
    solver_seconds: float | None
    call_seconds: float
    iterations: int | None


def raised(error: Exception, seconds: float) -> Reply:
    """The reply of a call that raised after some `seconds` [s]."""
    words = " ".join(f"{type(error).__name__}: {error}".split())[:200]
    return Reply(None, None, words, False, None, seconds, None)


def step_of(form: StandardForm) -> StepData:
    """The step whose standard form is a given quadratic program: h = 1, K_q = H, rows as extra."""
    n, m = len(form.g), len(form.b)
    nothing, frames = np.zeros(0), np.zeros((0, 3))
    return StepData(
        h=1.0,
        K_q=form.H,
        M_u=np.zeros((0, 0)),
        tau_a=form.g,
        tau_u=nothing,
        delta_q_bar_a=np.zeros(n),
        contacts=Contacts((), nothing, frames, frames, frames, np.zeros((0, 4, n)), nothing,
                          nothing, np.zeros(0, dtype=np.int64)),
        extra=Extra(tuple(f"row {i}" for i in range(m)), form.A, form.b),
    )  # fmt: skip
