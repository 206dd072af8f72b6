r"""A start of the exact method, refined where float64 cannot see.

Of the four corners of a face three say where it is, and the fourth follows but for the rounding of
J and phi. So where bodies rest on flat faces the optimum hangs on 1e-16 m, then, among the rows
that agree so far, on 1e-33 m, and so on, and one row after the other would have to enter W.

A solver in float64 sees these digits in units of their own, as in the iterative refinement of
linear programs (Gleixner, Steffy and Wolter, 2016). With s and y the exact slacks and multipliers
at the minimiser on W, and v the largest violation, the correction v d of x is that of

.. math:: \min \tfrac{\sigma}{2} d^T H d + (A^T y)^T d \quad\text{s.t.}\quad A d \ge -s / v,

and the rows that bear in it are the next W. It is a guess, from which the exact method goes on.
"""

from collections.abc import Sequence
from typing import Final, Protocol

import numpy as np

from quasistatic_ref.exact.minimiser import LARGE, Minimiser
from quasistatic_ref.exact.program import ExactProgram
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.precision import working_precision

MORE: Final = 128
"""Bits of balls, beside those of the form, in which these digits are seen."""
ROUNDS: Final = 6
"""Most corrections; each takes some sixteen digits more into account."""
GAIN: Final = 0.05
"""A correction that leaves more than this share of the violation is the last."""
LEAST: Final = 1e-7
"""Least sigma: the cost of a correction that rows leave free [-]."""
FAR_FROM_TIGHT: Final = 1e7
"""Slacks of more than so many violations do not bear [-]."""


class BearingRows(Protocol):
    """Finds the rows that bear at the optimum of a QP in float64."""

    def __call__(self, H: Array, f: Array, A: Array, lower: Array) -> Indices:
        """Of min 1/2 x'Hx + f'x s.t. A x >= lower, the largest multiplier first; maybe none."""


class Start(Protocol):
    """A function that picks the rows that bear among some, and gives the minimiser on them."""

    def __call__(self, form: ExactProgram, warm: Sequence[int], bits: int) -> Minimiser:
        """The minimiser on the rows among `warm` that bear, in balls of `bits` bits."""


def refined(minimiser: Minimiser, bearing: BearingRows, start: Start) -> Minimiser:
    """A minimiser with positive multipliers whose violations are far smaller, if one is seen.

    Parameters
    ----------
    minimiser : Minimiser
        With positive multipliers, and no equations.
    bearing : BearingRows
    start : Start
    """
    form = minimiser.form
    A, _ = form.inequalities
    H = np.array([float(v) for v in form.H.entries()]).reshape(form.n, form.n)
    unit = 1 / np.sqrt(np.diag(H))
    H = H * np.outer(unit, unit)
    A = A * unit
    length = np.sqrt(np.square(A).sum(axis=1))
    length[length == 0] = 1
    A = A / length[:, None]
    before = np.inf
    for _ in range(ROUNDS):
        slack = exact_slacks(minimiser) / length
        worst = -slack.min(initial=0.0)
        if not 0 < worst <= GAIN * before:
            break
        before = worst
        near = np.flatnonzero(slack < FAR_FROM_TIGHT * worst)
        y = np.array([float(v) for v in minimiser.balls.y])
        pull = A[list(minimiser.working)].T @ (y * length[list(minimiser.working)])
        size = np.abs(pull).max(initial=0.0) or 1.0
        sigma = max(LEAST, worst / size)
        rows = near[bearing(sigma * H, pull / size, A[near], -slack[near] / worst)]
        if len(rows) <= LARGE:
            break
        minimiser = start(form, rows.tolist(), form.bits + MORE)
    return minimiser


def exact_slacks(minimiser: Minimiser) -> Array:
    """Slacks, (m,) [m], however small: 0 in W, and where balls do not tell them from 0."""
    slack, _ = minimiser.float_slacks
    rows = minimiser.open_rows
    slack = slack.copy()
    with working_precision(minimiser.bits):
        balls = minimiser.form.slacks(rows, minimiser.balls.z)
    slack[rows] = [0.0 if v.contains(0) else float(v.mid()) for v in balls]
    slack[list(minimiser.working)] = 0.0
    return slack
