"""A derivative of a step along one direction: one-sided differences of exact steps.

A step is smooth piece by piece, and an exact one has no noise but rounding. A one-sided difference
of second order is therefore right to some ten digits while no piece ends within it. Differences
become smaller until both sides agree; where they never do, there is a kink or a jump.
"""

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from quasistatic_ref.certify.groups import row_owners
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.derivatives.nearby import Changes, End, Nearby
from quasistatic_ref.step.solution import StepSolution
from quasistatic_ref.step.standard_form import standard_form

SHARES: Final = (1e-3, 1e-4, 1e-5, 1e-6)
"""Sizes of the differences, of a parameter's own size [-]."""

EQUAL: Final = 1e-6
"""Relative difference up to which two slopes count as equal [-]: what is left of the third
derivative, of bodies of a millimetre and more."""

OPEN: Final = 1e-4
"""Slack beyond which a row is open [-], relative to what q+ changes by."""

POWER: Final = 1.5
"""Power of the way with which slack begins, between that of a kink and that of a curve [-]."""

FINER: Final = 100.0
"""By how much the error of a slope falls from one size to the next: it is of second order [-]."""


class Side(NamedTuple):
    """The steps on one side of the current parameters, and their difference quotients.

    Parameters
    ----------
    eps : float
        Share of the direction at which the nearest one is, with its sign [-].
    ends : list of End
        That, and the one twice as far; fewer where they are refused.
    problem : str
        Why one is refused.
    """

    eps: float
    ends: list[End]
    problem: str = ""

    @property
    def slope(self) -> Array:
        """The one-sided derivative of q+, shape (n_v,) [m or rad, per direction]."""
        near, far = self.ends
        return (4 * near.change - far.change) / (2 * self.eps)


class Column(NamedTuple):
    """The derivative along one direction, from both sides.

    Parameters
    ----------
    rate, below, above : ndarray, shape (n_v,)
        The derivative and the one-sided ones [m or rad, per direction]; NaN where there is none,
        or no second difference confirms it.
    holds : float
        How far from here steps were compared, on both sides [of directions].
    rows, points : tuple of str
        At a kink: the rows without slack on one side only, and the closest points on one side only.
    problem : str
        Why there is no derivative; empty if there is one.
    """

    rate: Array
    below: Array
    above: Array
    holds: float
    rows: tuple[str, ...] = ()
    points: tuple[str, ...] = ()
    problem: str = ""


def column(near: Nearby, direction: Changes) -> Column:
    """The derivative along a direction, of about the parameters' own sizes.

    Parameters
    ----------
    near : Nearby
    direction : mapping
        What each of some parameters changes by.
    """
    nowhere = np.full(near.result.step.n_v, np.nan)
    if unknown := near.unknown(direction):
        return Column(nowhere, nowhere, nowhere, 0.0, problem=unknown)
    rounding = near.rounding(direction)
    aboves: list[Side] = []
    belows: list[Side] = []
    for eps in SHARES:
        above = _side(near, direction, eps)
        below = _side(near, direction, -eps)
        sides = below, above
        aboves.append(above)
        belows.append(below)
        if len(above.ends) + len(below.ends) < 4:
            continue
        far, up, down = above.ends[1].change, above.ends[0].change, below.ends[0].change
        central = (up - down) / (2 * eps)
        # A kink at eps / 2 leaves one side's slope equal to this, not both.
        agree = all(_equal(side.slope, central, rounding / eps) for side in sides)
        if agree and not _left(near, direction, *sides).any():
            rate = (6 * up - far - 2 * down) / (6 * eps)  # of third order
            return Column(rate, rate, rate, eps)
    from_below = _slope(belows, rounding, nowhere)
    from_above = _slope(aboves, rounding, nowhere)
    only = {-1.0: from_below, 1.0: from_above}.get(near.only_side(direction), nowhere)
    if np.isfinite(only).all():
        return Column(only, from_below, from_above, SHARES[-1])
    rows, points, problem = _difference(*sides)
    if not problem:
        rows = near.names_of_closed(_left(near, direction, *sides))
        problem = f"rows without slack here, and with slack nearby: {', '.join(rows)}"
        if not rows:
            problem = "both sides have the same rows and points, which change differently"
    return Column(nowhere, from_below, from_above, SHARES[-1], rows, points, problem)


def _side(near: Nearby, direction: Changes, eps: float) -> Side:
    """The steps at eps and at 2 eps along a direction, up to one that is refused."""
    ends: list[End] = []
    for times in (1, 2):
        changes = {name: times * eps * change for name, change in direction.items()}
        try:
            ends.append(near.end(changes))
        except QuasistaticError as error:
            return Side(eps, ends, str(error))
    return Side(eps, ends)


def _left(near: Nearby, direction: Changes, *sides: Side) -> Mask:
    """Of the rows without slack here, (k,), those that have some on a side: (R25) and (R27) fail.

    While a step is smooth they have none, but for a power of the way, the second or a higher one:
    at twice the way, and at a tenth.
    """
    every = [_left_on(near, direction, side) for side in sides]
    return np.asarray(np.logical_or.reduce(every))


def _left_on(near: Nearby, direction: Changes, side: Side) -> Mask:
    (once, rounding), (twice, _) = map(near.slack, side.ends)
    rounding = rounding + near.rounding_of_slack(direction)
    is_open = once > rounding
    tenth = _side(near, direction, side.eps / 10) if is_open.any() else side
    if not (is_open.any() and tenth.ends):
        return is_open
    with np.errstate(divide="ignore", invalid="ignore"):
        power = np.log2(np.maximum(twice, 0.0) / once)
        expected = once * 0.1**power
    off = np.abs(near.slack(tenth.ends[0])[0] - expected)
    return is_open & ~((power > POWER) & (off <= expected / 2 + rounding))


def _equal(one: Array, other: Array, rounding: float) -> bool:
    """Whether two slopes are the same, but for a `rounding` of theirs."""
    slopes = np.array([one, other])
    most = EQUAL * np.abs(slopes).max(initial=0.0) + rounding
    return bool(np.abs(one - other).max(initial=0.0) <= most)


def _slope(sides: Sequence[Side], rounding: float, nowhere: Array) -> Array:
    """The first slope, of differences that get smaller, that the next confirms; or nowhere.

    Of both follows the one without their error of second order.
    """
    slopes = [side.slope if len(side.ends) == 2 else nowhere for side in sides]
    for slope, smaller, side in zip(slopes, slopes[1:], sides[1:], strict=False):
        if _equal(slope, smaller, rounding / abs(side.eps)):
            return (FINER * smaller - slope) / (FINER - 1)
    return nowhere


def _difference(below: Side, above: Side) -> tuple[tuple[str, ...], tuple[str, ...], str]:
    """The rows and the points in which two sides differ, and that in words, if there are any."""
    problem = below.problem or above.problem
    if problem:
        return (), (), f"a step nearby is refused: {problem}"
    moved = max(np.abs(side.ends[0].change).max() for side in (below, above))
    here, there = (_closed(side.ends[0].solution, OPEN * moved) for side in (below, above))
    rows = []
    points = []
    for name in sorted(here.keys() | there.keys()):
        if name in here and name in there:
            rows += [f"{row} of {name}" for row in sorted(here[name] ^ there[name])]
        elif here.get(name, there.get(name)):
            points.append(name)
    words = []
    if rows:
        words.append(f"rows without slack on one side only: {', '.join(rows)}")
    if points:
        words.append(f"closest points on one side only: {', '.join(points)}")
    return tuple(rows), tuple(points), "; ".join(words)


def _closed(solution: StepSolution, slack: float) -> dict[str, set[str]]:
    """The rows of each contact that have no more slack than this [m], by names."""
    step = solution.step
    form = standard_form(step)
    closed = np.flatnonzero(form.A @ solution.delta_q - form.b <= slack)
    owners = row_owners(step, closed)
    return {name: set(owners.get(name, ())) for name in step.contacts.name}
