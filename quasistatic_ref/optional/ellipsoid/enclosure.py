r"""The answer of a step in the ellipsoid, with a rigorous bound of its error.

By strong convexity any x strictly inside of the cones, and any y inside of them too, give

.. math:: \tfrac12\|x - x^*\|_H^2 \le f(x) - d(y)
          = \tfrac12\|x - H^{-1}(g + A^T y)\|_H^2 + y^T (A x - b).

The pair comes from Newton's method if a backend's answer is a good start, and otherwise from a cold
interior point in 640 bits. Membership and gap are then proved in balls.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final, TypeAlias

import numpy as np
from flint import arb, arb_mat, ctx, fmpq

from quasistatic_ref.certify.gap import duality_gap, fractions
from quasistatic_ref.certify.minimiser import (
    BallForm,
    form_in_balls,
    inner,
    rational_solution,
    square_root,
)
from quasistatic_ref.certify.rational import ExactForm, exact_form
from quasistatic_ref.certify.rounding import nearest_above, nearest_in, rounded_solution
from quasistatic_ref.optional.ellipsoid.apex import apex_refutation, apex_rows
from quasistatic_ref.optional.ellipsoid.gap import in_joules, negligible
from quasistatic_ref.optional.ellipsoid.impulses import raised
from quasistatic_ref.optional.ellipsoid.interior import Pair, Vector, interior_point
from quasistatic_ref.optional.ellipsoid.newton import OPEN, STICKS, contact_states, newton_pair
from quasistatic_ref.optional.ellipsoid.scaled_blocks import ScaledBlocks, largest, scaled_blocks
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.tolerances import ENCLOSED

BITS: Final = 640
"""Precision of the interior point: where contacts are at the limit of friction, its linear systems
lose five digits for each that the gap gains."""

GAP: Final = arb(2) ** -120
"""Duality gap at which the interior point stops, 1e-36 in units in which the unconstrained step has
length one: an error of 1e-18."""

RESERVE: Final = 16 * GAP
"""What Newton's pair, far sharper, claims beyond its own gap: `verify` has the interior point's,
whose gap may be a few times GAP, and the two may be on opposite sides of the optimum."""

IDLE: Final = arb(2) ** -40
"""Multipliers and slacks below this share of the largest count as zero when it is guessed which
contacts are at their apex; what follows from the guess is checked."""

ROUNDS: Final = 10
"""Changes of the states of contacts, at most: Newton's method ends in one or two on grasps."""

Start: TypeAlias = tuple[Array, Array]


@dataclass(frozen=True, eq=False)
class Enclosure:
    """The optimum of a step in the ellipsoid.

    Parameters
    ----------
    delta_q : ndarray, shape (n_v,)
        [m, rad]; an entry that is not proved to differ from zero is 0.0.
    lam : ndarray, shape (m,)
        Impulses (n, d1, d2, spin) of each contact [N s, N m s], each inside of its cone as it
        stands, the user's own rows last.
    net : ndarray, shape (n_v,)
        H delta_q - g [N s, N m s].
    working_set : tuple of int or None
        Independent rows that determine delta_q if every loaded contact is at its apex, else None.
    error : float
        Upper bound of ||delta_q - delta_q*||_H / ||H^-1 g||_H [-]; 0.0 where delta_q is delta_q*
        correctly rounded.
    gap : float
        Upper bound of f(delta_q*) - d(lam) [N m s].
    """

    delta_q: Array
    lam: Array
    net: Array
    working_set: tuple[int, ...] | None
    error: float
    gap: float


@dataclass(frozen=True, eq=False)
class Guess:
    """What the interior point, or Newton's method, came to.

    Parameters
    ----------
    x, y : arb_mat, list of list of arb
        In the units of the form, y by block.
    loaded, held : list of bool
        Which blocks seem to bear load, and which to be at their apex.
    reserve : arb
        Claimed beyond the pair's gap, where the unconstrained step has length one.
    """

    x: arb_mat
    y: list[Vector]
    loaded: list[bool]
    held: list[bool]
    reserve: arb


@dataclass(frozen=True, eq=False)
class Checked:
    """A pair that was checked in balls, in the units of its form.

    Parameters
    ----------
    x : arb_mat
        Without radius.
    lam : list of arb
        Impulses.
    gap, free : arb
        An upper bound of 1/2 ||x - x*||_H^2, and ||H^-1 g||_H.
    """

    x: arb_mat
    lam: list[arb]
    gap: arb
    free: arb


def enclosure(step: StepData, start: Start | None = None) -> Enclosure | None:
    """The optimum of a step in the ellipsoid, or None where none can be certified.

    It is None where a contact bears load and no displacement strictly inside of all cones is found.

    Parameters
    ----------
    step : StepData
    start : (ndarray, ndarray), optional
        A backend's delta_q and lam in SI units, shapes (n_v,) and (m,). A good one saves the
        interior point.

    Returns
    -------
    Enclosure or None
    """
    form = exact_form(step)
    balls = form_in_balls(form)
    nothing = np.zeros(form.m)
    if apex_refutation(step, form, (), nothing) is None:  # no contact bears load
        delta_q, _, net, _ = rounded_solution(form, rational_solution(form, ()))
        return Enclosure(delta_q, nothing, net, (), 0.0, 0.0)
    with ctx.workprec(BITS):
        frame = scaled_blocks(step, form, balls)
        found = (_enclosed(step, form, balls, frame, g) for g in guesses(form, frame, start))
        return next(filter(None, found), None)


def _enclosed(
    step: StepData, form: ExactForm, balls: BallForm, frame: ScaledBlocks, guess: Guess
) -> Enclosure | None:
    """Return what a guess proves; None if that is too little."""
    found = checked(form, balls, frame, guess.x, guess.y)
    if found is None:
        return None
    reserve = guess.reserve * frame.size * frame.size  # in the form's units of energy
    lam = _impulses(step, form, frame, found, guess)
    exact = _at_apex(step, form, guess, lam)
    net = _net(form, found)
    if exact is not None:
        working, x, delta_q = exact
        error = 0.0
    else:
        working = None
        x = point(found)
        delta_q = rounded_displacement(form, balls, found)
        error = enclosed_error(form, replace(found, gap=found.gap + reserve), delta_q)
    gap = duality_gap(form, x, fractions(lam, form.lam_unit))
    gap += 0 if exact is not None else fraction(reserve.upper())
    if not (error < ENCLOSED and negligible(form, x, gap)):
        return None
    return Enclosure(delta_q, lam, net, working, error, in_joules(form, gap))


def checked_pair(step: StepData, gap: arb = GAP, bits: int = BITS) -> Checked | None:
    """A pair strictly inside of all cones, checked in balls; None if none is found.

    Parameters
    ----------
    step : StepData
    gap : arb
        Duality gap at which to stop, where the unconstrained step has length one.
    bits : int
        Precision, five times as many as the gap has.
    """
    form = exact_form(step)
    balls = form_in_balls(form)
    with ctx.workprec(bits):
        frame = scaled_blocks(step, form, balls)
        pair = interior_point(frame.problem, gap)
        return None if pair is None else checked(form, balls, frame, *frame.pair(pair))


def enclosed_error(form: ExactForm, found: Checked, delta_q: Array) -> float:
    """How far float64 numbers are from the optimum, at most, in the one definition of error [-]."""
    off = arb_mat([[arb(float(v)) / form.x_unit] for v in delta_q]) - found.x
    length = square_root(inner(off, arb_mat(form.H) * off)) + square_root(2 * found.gap)
    return nearest_above(length / found.free) if found.free > 0 else float("inf")


def point(found: Checked) -> list[fmpq]:
    """The x of a checked pair, without rounding, in the units of its form [-]."""
    return [fraction(v) for v in found.x.entries()]


def fraction(v: arb) -> fmpq:
    """A number without radius as a fraction [of its unit]."""
    m, e = v.man_exp()
    return m * fmpq(2) ** int(e)


def guesses(form: ExactForm, frame: ScaledBlocks, start: Start | None) -> Iterator[Guess]:
    """Guesses: Newton's first, which round to the same bits from any `start`."""
    if start is not None:
        yield from _by_newton(frame, *frame.start(form, *start))
    pair = interior_point(frame.problem, GAP)
    if pair is not None:
        yield from _by_newton(frame, pair.x, pair.y)
        yield _of_interior(frame, pair)


def _by_newton(frame: ScaledBlocks, x: arb_mat, y: list[Vector]) -> Iterator[Guess]:
    """Yield what Newton's method makes of a pair of the program, as long as its states change."""
    states = contact_states(frame.problem, x, y)
    for _ in range(ROUNDS):
        pair = newton_pair(frame.problem, x, y, states)
        if pair is None:
            return
        loaded = [state != OPEN for state in states]
        held = [state == STICKS for state in states]
        yield Guess(*frame.pair(pair), loaded, held, RESERVE)
        before = states
        x = pair.x
        y = pair.y
        states = contact_states(frame.problem, x, y)
        if states == before:
            return


def _of_interior(frame: ScaledBlocks, pair: Pair) -> Guess:
    """Return what the interior point found, in the units of the form."""
    x, y = frame.pair(pair)
    most = largest([v for y_j in y for v in y_j])
    loaded = [y_j[0] > IDLE * most for y_j in y]
    held = [s_j[0] < IDLE for s_j in pair.s]
    return Guess(x, y, loaded, held, arb(0))


def checked(
    form: ExactForm, balls: BallForm, frame: ScaledBlocks, x: arb_mat, y: list[Vector]
) -> Checked | None:
    """A pair x, y in the form's units with its gap, if s and y surely lie inside of all cones."""
    motion = (balls.A * x - balls.b).entries()
    mu = frame.mu
    s = [
        [mu[i] * motion[i] + c * y_i for i, y_i in zip(block, y_j, strict=True)]
        for block, c, y_j in zip(frame.blocks, frame.give, y, strict=True)
    ]
    for one in (*s, *y):
        if not (one[0] > 0 and one[0] * one[0] > sum((v * v for v in one[1:]), arb(0))):
            return None
    lam = [mu_i * y_i for mu_i, y_i in zip(mu, [v for y_j in y for v in y_j], strict=True)]
    push = balls.A.transpose() * arb_mat(len(lam), 1, lam)
    off = x - balls.x_free - balls.H_inv * push
    H = arb_mat(form.H)
    work = sum((u * v for a, b in zip(s, y, strict=True) for u, v in zip(a, b, strict=True)),
               arb(0))  # fmt: skip
    gap = inner(off, H * off) / 2 + work
    free = inner(balls.x_free, H * balls.x_free)
    return Checked(x, lam, gap, square_root(free))


def _impulses(
    step: StepData, form: ExactForm, frame: ScaledBlocks, found: Checked, guess: Guess
) -> Array:
    """Return lam in float64, zero where a contact hardly bears load, inside of its cones."""
    lam = np.array([float(v * form.lam_unit) for v in found.lam])
    for block, loaded in zip(frame.blocks, guess.loaded, strict=True):
        lam[list(block)] *= loaded
    return raised(step, lam + 0.0)


def rounded(ball: arb) -> float:
    """The float64 nearest to a ball [its unit]; 0.0 if it holds zero."""
    nearest = nearest_in(ball)
    if ball.contains(0):
        return 0.0
    return float(ball) if nearest is None else nearest


def rounded_displacement(form: ExactForm, balls: BallForm, found: Checked) -> Array:
    """The x of a pair in float64, shape (n_v,) [m, rad]; an entry that may be zero is zero."""
    values = []
    for v in range(form.n):
        radius = square_root(2 * found.gap * balls.H_inv[v, v])
        middle = found.x[v, 0]
        values.append(rounded((middle + arb(0, radius.upper())) * form.x_unit))
    return np.array(values)


def _at_apex(
    step: StepData, form: ExactForm, guess: Guess, lam: Array
) -> tuple[tuple[int, ...], list[fmpq], Array] | None:
    """Return the rational optimum where every contact that bears load is at its apex.

    Its working set, the point itself in the form's units, and that rounded.
    """
    if any(loaded and not held for loaded, held in zip(guess.loaded, guess.held, strict=True)):
        return None
    working = apex_rows(step, form, lam)
    if apex_refutation(step, form, working, lam):
        return None
    solution = rational_solution(form, working)
    x = [fmpq(v) / solution.denominator for v in solution.x]
    return working, x, rounded_solution(form, solution)[0]


def _net(form: ExactForm, found: Checked) -> Array:
    net = arb_mat(form.H) * found.x - arb_mat(form.g)
    return np.array([float(v * form.net_unit) for v in net.entries()]) + 0.0
