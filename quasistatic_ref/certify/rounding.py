"""From exact numbers and from balls to float64, rounded correctly (half to even)."""

import math
from collections.abc import Callable, Sequence
from typing import Literal

import numpy as np
from flint import arb, ctx, fmpq, fmpz
from numpy.typing import NDArray

from quasistatic_ref.certify.minimiser import PRECISION, Minimiser, RationalSolution
from quasistatic_ref.certify.rational import ExactForm
from quasistatic_ref.step.data import Array


def nearest(p: int, q: int) -> float:
    """The float64 nearest to p / q [-], ties to even; subnormals too, and never -0.0.

    Parameters
    ----------
    p, q : int
        q > 0.

    Returns
    -------
    float
    """
    try:
        return p / q + 0.0  # Python divides integers with correct rounding
    except OverflowError:
        return float("inf") if p > 0 else float("-inf")


def nearest_fraction(x: fmpq) -> float:
    """The float64 nearest to a fraction [-]."""
    return nearest(int(x.p), int(x.q))


def nearest_in(ball: arb) -> float | None:
    """The float64 nearest to every number in a ball, or None if there is no such float64.

    None mostly means that the ball has a radius and holds zero, or a number half-way between two
    float64 numbers.
    """
    x = float(ball) + 0.0  # of its midpoint: a candidate, never -0.0
    below = math.nextafter(x, -math.inf)
    above = math.nextafter(x, math.inf)
    if not (math.isfinite(below) and math.isfinite(above)):
        return None
    if 2 * ball > arb(below) + x and 2 * ball < arb(above) + x:
        return x
    low = _exact(ball.lower())
    high = _exact(ball.upper())
    return low if low == high else None


def nearest_above(ball: arb) -> float:
    """A float64 that no number in a ball exceeds [of the unit of the ball]."""
    top = ball.upper()
    if not top.is_finite():
        return float("inf")
    return math.nextafter(_exact(top), math.inf) if top != 0 else 0.0


def _exact(point: arb) -> float:
    """Return the float64 nearest to a ball without radius; NaN if the ball is not finite."""
    if not point.is_finite():
        return float("nan")  # unequal to itself: never taken for an answer
    m, e = point.man_exp()
    return nearest(int(m) << max(int(e), 0), 1 << max(-int(e), 0))


def nearest_numbers(
    minimiser: Minimiser,
    name: Literal["x", "lam", "net", "slack"],
    unit: fmpq,
    entries: Sequence[int] | NDArray[np.int64],
    zeros: Callable[[Sequence[int]], Sequence[int]] = lambda _: (),
) -> Array:
    """Some numbers of a minimiser, times a unit, in float64, rounded correctly, shape (entries,).

    Each of the `entries`, shape (entries,), of the field `name` of its solutions is rounded from
    its ball; where the ball leaves that open, it is zero if `zeros` proves so, and otherwise
    rounded from the rational solution.
    """
    rounded: dict[int, float | None] = {int(i): None for i in entries}
    if minimiser.balls is not None:
        balls = getattr(minimiser.balls, name)
        with ctx.workprec(PRECISION):
            factor = arb(unit)
            rounded = {i: nearest_in(balls[i] * factor) for i in rounded}
    undecided = [i for i, value in rounded.items() if value is None]
    rounded.update(dict.fromkeys(zeros(undecided), 0.0))
    for i in undecided:
        if rounded[i] is None:
            exact = minimiser.rational
            rounded[i] = nearest_fraction(unit * getattr(exact, name)[i] / exact.denominator)
    return np.array(list(rounded.values()), dtype=np.float64)


def rounded_solution(
    form: ExactForm, solution: RationalSolution
) -> tuple[Array, Array, Array, Array]:
    """Float64 numbers, rounded correctly.

    Returns
    -------
    delta_q : ndarray, shape (n_v,)
    lam : ndarray, shape (working,)
        On the working set [N s].
    net : ndarray, shape (n_v,)
        A'lam [N s, N m s].
    slack : ndarray, shape (m,)
    """

    def nearest(unit: fmpq, numerators: list[fmpz]) -> Array:
        return np.array([nearest_fraction(unit * v / solution.denominator) for v in numerators])

    return (
        nearest(form.x_unit, solution.x),
        nearest(form.lam_unit, solution.lam),
        nearest(form.net_unit, solution.net),
        nearest(form.slack_unit, solution.slack),
    )
