r"""The answer of a step in the ellipsoid, with a rigorous bound of its error.

By strong convexity any x strictly inside of the cones, and any y inside of them too, give

.. math:: \tfrac12\|x - x^*\|_H^2 \le f(x) - d(y)
          = \tfrac12\|x - H^{-1}(g + A^T y)\|_H^2 + y^T (A x - b).

The pair comes from an interior point in 640 bits, from a cold start: it is a function of the step
alone, whatever a backend said. Membership and gap are then computed in balls, where a comparison
that shows is true.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from flint import arb, arb_mat, ctx, fmpq

from quasistatic_ref.certify.apex import apex_refutation, apex_rows
from quasistatic_ref.certify.balls import BallForm, ball_form, square_root
from quasistatic_ref.certify.gap import duality_gap, fractions, in_joules, negligible
from quasistatic_ref.certify.impulses import ONE, cone_blocks, raised
from quasistatic_ref.certify.interior import Blocks, Pair, interior_point
from quasistatic_ref.certify.kkt import rational_solution, rounded_solution
from quasistatic_ref.certify.rational import ExactForm, exact_form
from quasistatic_ref.certify.rounding import nearest_above, nearest_in
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.tolerances import ENCLOSED

BITS: Final = 640
"""Precision of the interior point: where contacts are at the limit of friction, its linear systems
lose five digits for each that the gap gains."""

GAP: Final = arb(2) ** -120
"""Duality gap asked for, 1e-36, where the unconstrained step has length one: an error of 1e-18."""

IDLE: Final = arb(2) ** -40
"""Multipliers and slacks below this share of the largest count as zero when it is guessed which
contacts are at their apex; what follows from the guess is checked."""


@dataclass(frozen=True, eq=False)
class Enclosure:
    """The optimum of a step in the ellipsoid.

    Parameters
    ----------
    delta_q : ndarray, shape (n_v,)
        [m, rad]; what may be zero is zero.
    lam : ndarray, shape (m,)
        Impulses (n, d1, d2, spin) of each contact [N s, N m s], each inside of its cone as it
        stands, the user's own rows last.
    net : ndarray, shape (n_v,)
        H delta_q - g [N s, N m s].
    working_set : tuple of int or None
        Independent rows that delta_q follows from exactly, where every contact that bears load is
        at its apex; None where the answer is not rational.
    error : float
        ||delta_q - delta_q*||_H / ||H^-1 g||_H is at most that [-]; 0.0 where delta_q is exact but
        for the correct rounding of each entry.
    gap : float
        f(delta_q*) - d(lam) is at most that [N m s].
    """

    delta_q: Array
    lam: Array
    net: Array
    working_set: tuple[int, ...] | None
    error: float
    gap: float


@dataclass(frozen=True, eq=False)
class Guess:
    """What the interior point came to.

    Parameters
    ----------
    pair : Pair
        In the units of the form.
    loaded, held : list of bool
        Which blocks seem to bear load, and which to be at their apex.
    """

    pair: Pair
    loaded: list[bool]
    held: list[bool]


@dataclass(frozen=True, eq=False)
class Checked:
    """A pair that was checked in balls, in the units of its form.

    Parameters
    ----------
    x : arb_mat
        Without radius.
    lam : list of arb
        Impulses.
    gap : arb
        1/2 ||x - x*||_H^2 is at most that.
    free : arb
        ||H^-1 g||_H.
    """

    x: arb_mat
    lam: list[arb]
    gap: arb
    free: arb


def enclosure(step: StepData) -> Enclosure | None:
    """The optimum of a step in the ellipsoid, or None where none can be certified.

    That is where no displacement is strictly inside of all cones, or none at all.

    Parameters
    ----------
    step : StepData

    Returns
    -------
    Enclosure or None
    """
    form = exact_form(step)
    balls = ball_form(form)
    nothing = np.zeros(form.m)
    if apex_refutation(step, form, (), nothing) is None:  # no contact bears load
        delta_q, _, net, _ = rounded_solution(form, rational_solution(form, ()))
        return Enclosure(delta_q, nothing, net, (), 0.0, 0.0)
    with ctx.workprec(BITS):
        mu = _coefficients(step)
        guess = _interior(step, form, balls, mu)
        found = None if guess is None else _checked(step, form, balls, mu, guess.pair)
        if guess is None or found is None:
            return None
        lam = _impulses(step, form, found, guess)
        exact = _at_apex(step, form, guess, lam)
        net = _net(form, found)
        if exact is not None:
            working, x, delta_q = exact
            error = 0.0
        else:
            working, x, delta_q = None, point(found), _rounded(form, balls, found)
            error = enclosed_error(form, found, delta_q)
    gap = duality_gap(form, x, fractions(lam, form.lam_unit))
    if not (error < ENCLOSED and negligible(form, x, gap)):
        return None
    return Enclosure(delta_q, lam, net, working, error, in_joules(form, gap))


def checked_pair(step: StepData, gap: arb = GAP, bits: int = BITS) -> Checked | None:
    """A pair strictly inside of all cones, checked in balls; None if none is found.

    Parameters
    ----------
    step : StepData
    gap : arb
        Duality gap asked for, where the unconstrained step has length one.
    bits : int
        Precision, five times as many as the gap has.
    """
    form = exact_form(step)
    balls = ball_form(form)
    with ctx.workprec(bits):
        mu = _coefficients(step)
        guess = _interior(step, form, balls, mu, gap)
        return None if guess is None else _checked(step, form, balls, mu, guess.pair)


def enclosed_error(form: ExactForm, found: Checked, delta_q: Array) -> float:
    """How far float64 numbers are from the optimum, at most, in the one definition of error [-]."""
    off = arb_mat([[arb(float(v)) / form.x_unit] for v in delta_q]) - found.x
    length = square_root((off.transpose() * (arb_mat(form.H) * off))[0, 0]) + square_root(
        2 * found.gap
    )
    return nearest_above(length / found.free) if found.free > 0 else float("inf")


def point(found: Checked) -> list[fmpq]:
    """The x of a checked pair, without rounding, in the units of its form [-]."""
    return [m * fmpq(2) ** int(e) for m, e in (v.man_exp() for v in found.x.entries())]


def _coefficients(step: StepData) -> list[arb]:
    """Return what each row of A is multiplied by: 1, mu_v, mu_v, mu_omega; 1 for own rows."""
    return [arb(v) for _, _, mu in cone_blocks(step) for v in (ONE, *mu)]


def _blocks(step: StepData) -> list[range]:
    return [rows for _, rows, _ in cone_blocks(step)]


def _interior(
    step: StepData, form: ExactForm, balls: BallForm, mu: list[arb], gap: arb = GAP
) -> Guess | None:
    """Return a pair in the units of the form, found in units of about one."""
    n = form.n
    root = [(1 / arb(form.H[v, v]).sqrt()).mid() for v in range(n)]
    blocks = _blocks(step)
    rows = [
        [[mu[i] * balls.A[i, v] * root[v] for v in range(n)] for i in block] for block in blocks
    ]
    length = [_largest([a for row in block for a in row]) for block in rows]
    gaps = [abs(balls.b[block[0], 0]) / ell for block, ell in zip(blocks, length, strict=True)]
    free = square_root((balls.x_free.transpose() * (arb_mat(form.H) * balls.x_free))[0, 0])
    size = (free if free > 0 else max([arb(0), *(g.mid() for g in gaps)]) or arb(1)).mid()
    size = size if size > 0 else arb(1)
    problem = Blocks(
        H=arb_mat(
            n, n, [root[u] * form.H[u, v] * root[v] for u in range(n) for v in range(n)]
        ).mid(),
        g=arb_mat(n, 1, [root[v] * form.g[v, 0] / size for v in range(n)]).mid(),
        A=[
            arb_mat(len(block), n, [a / ell for row in block for a in row]).mid()
            for block, ell in zip(rows, length, strict=True)
        ],
        b=[
            arb_mat(len(block), 1, [mu[i] * balls.b[i, 0] / (ell * size) for i in block]).mid()
            for block, ell in zip(blocks, length, strict=True)
        ],
    )
    pair = interior_point(problem, gap)
    if pair is None:
        return None
    x = arb_mat(n, 1, [size * root[v] * pair.x[v, 0] for v in range(n)]).mid()
    s = [[size * ell * v for v in s_j] for ell, s_j in zip(length, pair.s, strict=True)]
    y = [[(size / ell * v).mid() for v in y_j] for ell, y_j in zip(length, pair.y, strict=True)]
    largest = _largest([v for y_j in y for v in y_j])
    loaded = [y_j[0] > IDLE * largest for y_j in y]
    held = [s_j[0] < IDLE for s_j in pair.s]
    return Guess(Pair(x, s, y), loaded, held)


def _checked(
    step: StepData, form: ExactForm, balls: BallForm, mu: list[arb], pair: Pair
) -> Checked | None:
    """Return the pair with its gap, if it surely lies inside of all cones."""
    motion = (balls.A * pair.x - balls.b).entries()
    s = [[mu[i] * motion[i] for i in block] for block in _blocks(step)]
    for one in (*s, *pair.y):
        if not (one[0] > 0 and one[0] * one[0] > sum((v * v for v in one[1:]), arb(0))):
            return None
    lam = [mu_i * y_i for mu_i, y_i in zip(mu, [v for y in pair.y for v in y], strict=True)]
    push = balls.A.transpose() * arb_mat(len(lam), 1, lam)
    off, H = pair.x - balls.x_free - balls.H_inv * push, arb_mat(form.H)
    work = sum((u * v for a, b in zip(s, pair.y, strict=True) for u, v in zip(a, b, strict=True)),
               arb(0))  # fmt: skip
    gap = (off.transpose() * (H * off))[0, 0] / 2 + work
    free = (balls.x_free.transpose() * (H * balls.x_free))[0, 0]
    return Checked(pair.x, lam, gap, square_root(free))


def _impulses(step: StepData, form: ExactForm, found: Checked, guess: Guess) -> Array:
    """Return lam in float64, zero where a contact hardly bears load, inside of its cones."""
    lam = np.array([float(v * form.lam_unit) for v in found.lam])
    for block, loaded in zip(_blocks(step), guess.loaded, strict=True):
        lam[list(block)] *= loaded
    return raised(step, lam + 0.0)


def _rounded(form: ExactForm, balls: BallForm, found: Checked) -> Array:
    """Return x in float64; an entry that may be zero is zero."""
    values = []
    for v in range(form.n):
        radius = square_root(2 * found.gap * balls.H_inv[v, v])
        middle = found.x[v, 0]
        ball = (middle + arb(0, radius.upper())) * form.x_unit
        nearest = nearest_in(ball)
        values.append(0.0 if ball.contains(0) else float(ball) if nearest is None else nearest)
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


def _largest(values: list[arb]) -> arb:
    largest = max((abs(v).mid() for v in values), default=arb(0))
    return largest if largest > 0 else arb(1)
