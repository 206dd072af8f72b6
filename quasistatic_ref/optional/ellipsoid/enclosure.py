r"""The answer of a step in the ellipsoid, with a rigorous bound of its error.

By strong convexity any x strictly inside of the cones, and any y inside of them too, give

.. math:: \tfrac12\|x - x^*\|_H^2 \le f(x) - d(y)
          = \tfrac12\|x - H^{-1}(g + A^T y)\|_H^2 + y^T (A x - b).

The pair comes from Newton's method if a backend's answer is a good start, and otherwise from a cold
interior point in 640 bits. Membership and gap are then proved in balls.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final, TypeAlias

import numpy as np
from flint import arb, arb_mat, fmpq

from quasistatic_ref.certify.groups import contact_rows
from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.exact.program import (
    EXACT,
    ExactProgram,
    exact_matrix,
    fraction,
    rounded_quotients,
)
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import working_precision
from quasistatic_ref.optional.ellipsoid.apex import apex
from quasistatic_ref.optional.ellipsoid.gap import negligible, rounded_up
from quasistatic_ref.optional.ellipsoid.impulses import raised
from quasistatic_ref.optional.ellipsoid.interior import Blocks, Pair, diagonal, interior_point
from quasistatic_ref.optional.ellipsoid.newton import OPEN, SLIDES, contact_states, newton_pair
from quasistatic_ref.optional.ellipsoid.scaled_blocks import ScaledBlocks, scaled_blocks
from quasistatic_ref.optional.ellipsoid.tolerances import ENCLOSED
from quasistatic_ref.optional.gap import (
    duality_gap,
    fractions,
    inner,
    nearest_above,
    nearest_in,
    square_root,
)
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.solution import Certificate

BITS: Final = 640
"""Precision of the interior point: where contacts are at the limit of friction, its linear systems
lose five digits for each that the gap gains."""

GAP: Final = arb(2) ** -120
"""Duality gap at which the interior point stops, 1e-36 in units in which the unconstrained step has
length one: an error of 1e-18."""

RESERVE: Final = 16 * GAP
"""What is claimed beyond a pair's own gap: `verify` has the interior point's pair, whose gap may be
a few times GAP, and Newton's, far sharper, may be on the opposite side of the optimum."""

ROUNDS: Final = 10
"""Changes of the states of contacts, at most: Newton's method ends in one or two on grasps."""

Start: TypeAlias = tuple[Array, Array]
Guess: TypeAlias = tuple[Pair, list[int]]
"""A pair of the scaled program, and what its contacts seem to do."""


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
        Upper bound of the error of delta_q, by its one definition (certify/norm.py) [-]; 0.0 where
        delta_q is delta_q* correctly rounded.
    gap : float
        Upper bound of f(delta_q*) - d(lam) [N m s].
    """

    delta_q: Array
    lam: Array
    net: Array
    working_set: tuple[int, ...] | None
    error: float
    gap: float

    def certificate(self, step: StepData, residuals: Mapping[str, float]) -> Certificate:
        """``"exact"`` where every loaded contact is at its apex, ``"enclosure"`` otherwise.

        Parameters
        ----------
        step : StepData
        residuals : mapping of str to float
            In natural units [-].
        """
        exact = self.working_set is not None
        return Certificate(
            kind="exact" if exact else "enclosure",
            residuals=dict(residuals),
            active=contact_rows(step, self.working_set or ()),
            error_bound=self.error,
            gap=self.gap,
            step=step,
        )


@dataclass(frozen=True, eq=False)
class Checked:
    """A primal and dual answer that was proved in balls to lie inside of all cones.

    Parameters
    ----------
    x : arb_mat
        Without radius [m, rad].
    y : list of arb
        Impulses times h.
    gap, least : arb
        An upper bound of 1/2 ||x - x*||_H^2, and what errors are divided by but for ||x*||_H, in
        the form's H and g.
    """

    x: arb_mat
    y: list[arb]
    gap: arb
    least: arb


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
    form = StepProgram(step)
    unloaded = _at_apex(step, form, np.zeros(form.m))
    if unloaded is not None:
        return unloaded
    with working_precision(BITS):
        frame = scaled_blocks(step, form)
        enclosures = (_enclosed(step, frame, *guess) for guess in guesses(frame, start))
        return next(filter(None, enclosures), None)


def _at_apex(step: StepData, form: ExactProgram, lam: Array) -> Enclosure | None:
    """The rational optimum if every contact that bears load is at its apex."""
    rows, exact, refutation = apex(step, form, lam)
    if refutation:
        return None
    gap = duality_gap(form, exact.exact_x, fractions(lam))
    if not negligible(form, exact.exact_x, gap):
        return None
    delta_q = rounded_quotients(exact.x, exact.denominator)
    with working_precision(EXACT):
        net = rounded_quotients(exact.net.entries(), exact.denominator * form.h)
    return Enclosure(delta_q, lam, net, rows, 0.0, rounded_up(gap))


def _enclosed(
    step: StepData, frame: ScaledBlocks, pair: Pair, states: list[int]
) -> Enclosure | None:
    """The optimum that a guess proves, with its error bound; None if the bound is too large."""
    form = frame.form
    checked_guess = checked(frame, pair)
    if checked_guess is None:
        return None
    lam = _impulses(step, frame, checked_guess, states)
    exact = None if SLIDES in states else _at_apex(step, form, lam)
    if exact is not None:
        return exact
    reserve = RESERVE * frame.size * frame.size  # in the form's units of energy
    delta_q = rounded_displacement(frame, checked_guess)
    error = enclosed_error(form, replace(checked_guess, gap=checked_guess.gap + reserve), delta_q)
    x = point(checked_guess)
    gap = fraction((reserve / form.h).upper()) + duality_gap(form, x, fractions(lam))
    if not (error < ENCLOSED and negligible(form, x, gap)):
        return None
    return Enclosure(delta_q, lam, _net(form, checked_guess), None, error, rounded_up(gap))


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
    with working_precision(bits):
        frame = scaled_blocks(step, StepProgram(step))
        pair = interior_point(frame.problem, gap)
        return None if pair is None else checked(frame, pair)


def enclosed_error(form: ExactProgram, pair: Checked, delta_q: Array) -> float:
    """How far float64 numbers are from the optimum, at most, in the one definition of error [-]."""
    off = exact_matrix(delta_q[:, None]) - pair.x
    apart = square_root(2 * pair.gap)  # of the pair's x from x*
    error = square_root(inner(off, form.H * off)) + apart
    optimum = square_root(inner(pair.x, form.H * pair.x)) - apart
    return nearest_above(error / max(pair.least, optimum.lower()))


def point(pair: Checked) -> list[fmpq]:
    """The x of a checked pair, without rounding [m, rad]."""
    return [fraction(v) for v in pair.x.entries()]


def guesses(frame: ScaledBlocks, start: Start | None) -> Iterator[Guess]:
    """Candidate optima, those of Newton's method from `start` before the others."""
    if start is not None:
        yield from _by_newton(frame.problem, frame.start(*start))
    pair = interior_point(frame.problem, GAP)
    if pair is not None:
        yield from _by_newton(frame.problem, pair)
        yield pair, contact_states(frame.problem, pair)


def _by_newton(problem: Blocks, pair: Pair) -> Iterator[Guess]:
    """Yield the results of Newton's method from a pair, as long as contact states change."""
    before = None
    for _ in range(ROUNDS):
        states = contact_states(problem, pair)
        if states == before:
            return
        minimum = newton_pair(problem, pair, states)
        if minimum is None:
            return
        yield minimum, states
        before = states
        pair = minimum


def checked(frame: ScaledBlocks, pair: Pair) -> Checked | None:
    """A pair of the program with its gap, if its s and y surely lie inside of all cones."""
    form = frame.form
    x, y = frame.in_form(pair)
    mu = diagonal(frame.mu)
    motion = form.A * x + form.c
    s = mu * motion + diagonal(frame.give) * y
    for first, *others in frame.problem.split(s) + frame.problem.split(y):
        if not (first > 0 and first * first > sum((v * v for v in others), arb(0))):
            return None
    impulses = mu * y
    off = x - form.H_inverse * (form.g + form.A.transpose() * impulses)
    gap = inner(off, form.H * off) / 2 + inner(s, y)
    return Checked(x, impulses.entries(), gap, frame.least)


def _impulses(step: StepData, frame: ScaledBlocks, pair: Checked, states: list[int]) -> Array:
    """Lam in float64, zero where a contact is open, inside of its cones."""
    lam = np.array([float(v / frame.form.h) for v in pair.y])
    for rows, state in zip(frame.problem.rows, states, strict=True):
        if state == OPEN:
            lam[rows.start : rows.stop] = 0.0
    return raised(step, lam + 0.0)


def rounded(ball: arb) -> float:
    """The float64 nearest to a ball [its unit]; 0.0 if it holds zero."""
    nearest = nearest_in(ball)
    if ball.contains(0):
        return 0.0
    return float(ball) if nearest is None else nearest


def rounded_displacement(frame: ScaledBlocks, pair: Checked) -> Array:
    """The x of a pair in float64, shape (n_v,) [m, rad]; an entry that may be zero is zero."""
    values = []
    for v, middle in enumerate(pair.x.entries()):
        radius = square_root(2 * pair.gap * frame.form.H_inverse[v, v])
        values.append(rounded(middle + arb(0, radius.upper())))
    return np.array(values)


def _net(form: ExactProgram, pair: Checked) -> Array:
    net = form.H * pair.x - form.g
    return np.array([float(v / form.h) for v in net.entries()]) + 0.0
