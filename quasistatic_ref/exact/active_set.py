"""The dual active-set method of Goldfarb and Idnani (1983), with exact signs.

Each :class:`~quasistatic_ref.exact.minimiser.Minimiser` is the minimiser on a working set W of
independent rows; if all multipliers are >= 0, it is the optimum of the problem with the rows of W
alone. The method adds one violated row after the other.

Let a_p be the violated row and u the multipliers on W + {p}. Walk from the multipliers on W (that
of p being zero) towards u. If no multiplier becomes negative, W + {p} is the next working set (a
full step). Otherwise the first to vanish leaves W, and the walk goes on from where it is. Where a_p
is a combination of the rows of W, x cannot move: the walk is along the combination, and if no
multiplier ever vanishes the combination is a proof that the problem is infeasible.

Equations are in W from the start and never leave it: their multipliers have no sign. One that
depends on others follows from them, and is left out, or it contradicts them, which is the proof.

Termination. A walk drops at most |W| rows. It ends with the dual objective strictly larger: at
its start a_p x < b_p, and the dual objective grows at the rate b_p - a_p x > 0 in the multiplier
of p until the full step closes the violation, which needs a positive multiplier since x must move.
The dual objective after a walk is a function of the working set, so no working set comes back,
and there are finitely many. This holds with exact signs only, which is why ties are decided
before they are branched on.

It starts from the rows that a solver's answer shows to be active. An interior-point method returns
positive multipliers for all six rows of a sticking contact, whose rank is four. The exact method
needs independent rows with multipliers >= 0. Such a choice exists (Caratheodory): moving lam along
a dependence of the rows with positive multipliers changes neither A'lam nor the optimum, and each
move makes one multiplier zero. An active-set method returns such rows, but none that bears less
than float64 shows.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from flint import arb, fmpq

from quasistatic_ref.exact.minimiser import LARGE, Line, Minimiser
from quasistatic_ref.exact.program import ExactProgram, combination, fraction, independent_rows
from quasistatic_ref.exact.refined import BearingRows, refined
from quasistatic_ref.exact.time_limit import check_time
from quasistatic_ref.numbers import modulo
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import working_precision

AGAIN: Final = 4
"""Walks after which a start is refined again; then twice as many, and so on, so that walks end."""


@dataclass(frozen=True, eq=False)
class Combination:
    """Rows that contradict each other: y >= 0, A'y = 0, b'y > 0, without rounding (Farkas).

    Parameters
    ----------
    y : dict of int to fmpq
        The entries by row that are not zero; of equations they may be negative.
    """

    y: dict[int, fmpq]


def most_violated(minimiser: Minimiser) -> int | None:
    """The most violated row, of equal ones that of least index; None if none is violated.

    Of rows that float64 shows to be violated, if it shows any; otherwise the exact signs decide.
    Any violated row would do. With this one a grasp takes, from a cold start, a fifth of the walks
    that it takes with :func:`least_index`.
    """
    shown = minimiser.perhaps_most_violated
    if not shown:  # a row that balls show to be violated needs no zero to be decided
        by_balls = {i: float(ball) for i, ball in minimiser.slack_balls.items() if ball < 0}
        return min(by_balls, key=by_balls.__getitem__) if by_balls else least_exactly(minimiser)
    first, *others = shown
    for i in others:
        if minimiser.slack_is_less(i, first):
            first = i
    return first


def least_exactly(minimiser: Minimiser) -> int | None:
    """The violated row of least slack, where balls show none; of many rows that of least index."""
    violated = [i for i, sign in minimiser.slack_signs.items() if sign < 0]
    if minimiser.is_large or len(violated) < 2:
        return min(violated, default=None)
    exact = minimiser.exact_slacks(violated)
    least = violated[0]
    for i in violated:
        if exact[i] < exact[least]:
            least = i
    return least


def least_index(minimiser: Minimiser) -> int | None:
    """The violated row with the smallest index; None if exact signs show that no row is violated.

    The choice depends on exact signs alone: every implementation of the method takes the same path.
    """
    return min((i for i, sign in minimiser.slack_signs.items() if sign < 0), default=None)


def dual_active_set(
    form: ExactProgram, warm: Sequence[int] = (), bearing: BearingRows | None = None
) -> Minimiser | Combination:
    """The optimum of min 1/2 x'Hx - g'x s.t. Ax >= b, or a proof that there is none.

    Parameters
    ----------
    form : ExactProgram
        H positive definite.
    warm : sequence of int
        Rows that are active at the optimum, as far as a solver could tell, in order of
        preference. Any rows will do; none is a cold start.
    bearing : BearingRows, optional
        With it a start on many rows that is wrong is refined, and again after some walks, in a
        program without equations.

    Returns
    -------
    Minimiser or Combination
        At the optimum all of its multipliers are positive, but those of equations; its `iterations`
        are the rows that were added, none if the warm start was right.
    """
    minimiser = _start(form, list(dict.fromkeys([*range(form.equations), *warm])))
    contradiction = _contradicted_equation(form, minimiser.working)
    if contradiction is not None:
        return contradiction
    iterations = 0
    again = 0 if bearing is not None and not form.equations else None
    while True:
        check_time()
        p = most_violated(minimiser)
        if p is None:  # All slacks are >= 0, too: the optimum.
            positive = minimiser.rows_that_bear() if iterations else minimiser.working
            if positive != minimiser.working:
                minimiser = minimiser.on(positive)
            minimiser.iterations = iterations
            return minimiser
        if iterations == again and bearing is not None and len(minimiser.working) > LARGE:
            minimiser = refined(minimiser, bearing, _start)
            again = 2 * iterations + AGAIN
            continue
        after = _walk(minimiser, p)
        if isinstance(after, Combination):
            return after
        minimiser = after
        iterations += 1


def _start(form: ExactProgram, warm: Sequence[int], bits: int | None = None) -> Minimiser:
    """The minimiser on equations and warm rows, less the rows whose multipliers are not positive.

    In balls of some bits, by default those of the form.
    """
    working = tuple(warm)
    if len(working) > LARGE:
        chosen = modulo.independent_rows([row[:-1] for row in form.whole_rows(working)])
        working = tuple(working[place] for place in chosen)
    while True:
        minimiser = Minimiser(form, working, bits=bits)
        try:
            y = minimiser.balls.y
        except ZeroDivisionError:
            working = independent_rows(form, working)
            continue
        rows = zip(working, y, strict=True)
        positive = tuple(i for i, ball in rows if i < form.equations or ball > 0)
        if positive == working:
            return minimiser
        working = positive


def _contradicted_equation(form: ExactProgram, working: Sequence[int]) -> Combination | None:
    """A proof that an equation contradicts the equations in W on which it depends."""
    held = [i for i in working if i < form.equations]
    for p in sorted({*range(form.equations)} - {*held}):
        c = combination(form, held, p)
        assert c is not None  # W has as many independent equations as there are
        y = dict(zip([*held, p], [*(-c_j for c_j in c), fmpq(1)], strict=True))
        constants = (y_i * fraction(form.exact_rows([i])[0][-1]) for i, y_i in y.items())
        total = sum(constants, fmpq(0))
        if total:
            sign = -1 if total > 0 else 1
            return Combination({i: sign * y_i for i, y_i in y.items() if y_i})
    return None


def _walk(minimiser: Minimiser, p: int) -> Minimiser | Combination:
    """The minimiser after the violated row p enters W, or a proof that the program has none."""
    while True:
        check_time()
        working = minimiser.working
        line = minimiser.with_row(p)
        leaving = _first_to_vanish(minimiser, line)
        if leaving is not None:
            # The start of the next line; the walk is already inside of it.
            minimiser = minimiser.on(working[:leaving] + working[leaving + 1 :])
        elif isinstance(line, Minimiser):
            return line
        else:  # a_p = sum c_j a_j with c <= 0, and b_p > sum c_j b_j
            y = {i: u_j for j, i in enumerate(working) if (u_j := line.end(j))}
            return Combination({**y, p: fmpq(1)})


def _first_to_vanish(minimiser: Minimiser, line: Line) -> int | None:
    """Ratio test: index in W of the multiplier that vanishes first on a line, or None.

    Equations, the first of W, are passed over. l are the multipliers on W. The line goes towards
    u, those on W and p, or along u = -c. The index is that of the least l_j / -u_j over u_j < 0; of
    a tie the first of W. (On the line towards u the fraction l_j / (l_j - u_j) has the same order.)

    After a row has left, the method is at a point inside the line towards u, not at its start,
    where the multiplier of p is zero. The ratios of the whole line are valid all the same: a
    multiplier that is >= 0 at that point and ends at u_j < 0 decreases along the line, so that it
    vanishes at that point or after it.

    No sign of u_j is decided where balls show that, even if it falls, another vanishes before.
    """
    u = line.ends[: len(minimiser.working)]  # the multiplier of p rises
    free = sum(i < minimiser.form.equations for i in minimiser.working)
    signed = [*enumerate(u)][free:]
    shown = [j for j, ball in signed if ball < 0]
    one = min(shown, key=lambda j: float(minimiser.balls.y[j] / -u[j]), default=None)
    first = None
    for j, ball in signed:
        if ball > 0 or (one is not None and _difference(minimiser, line, j, one) > 0):
            continue
        falls = ball < 0 or line.end(j) < 0
        if falls and (first is None or _vanishes_before(minimiser, line, j, first)):
            first = j
    return first


def _difference(minimiser: Minimiser, line: Line, j: int, k: int) -> arb:
    """A number with the sign of l_j / -u_j - l_k / -u_k, where both u are negative."""
    l_balls = minimiser.balls.y
    u = line.ends
    with working_precision(minimiser.bits):
        return l_balls[k] * u[j] - l_balls[j] * u[k]


def _vanishes_before(minimiser: Minimiser, line: Line, j: int, k: int) -> bool:
    """Whether l_j / -u_j < l_k / -u_k, both u being negative."""
    difference = _difference(minimiser, line, j, k)
    if not difference.contains(0):
        return bool(difference < 0)
    return bool(minimiser.end(k) * line.end(j) < minimiser.end(j) * line.end(k))


ZERO_SHARE = 1e-9
"""Singular values, and entries of a dependence, below this share of the largest count as zero; a
wrong start costs steps of the active-set method, not correctness."""
ROUNDED: Final = 2.0**-54
"""What is less than this share of the largest multiplier is rounding [-], but for a third pair."""
BLOCK = 256
"""Most rows whose dependences are formed at once: the time for that is cubic in their number."""


def warm_rows(A: Array, lam: Array, slack: Array) -> list[int]:
    """Independent rows that carry A'lam, the largest multiplier first.

    Parameters
    ----------
    A : ndarray, shape (m, n_v)
    lam, slack : ndarray, shape (m,)
        A solver's multipliers and A delta_q - b; all in natural units (numbers near one).

    Returns
    -------
    list of int
        A start for :func:`~quasistatic_ref.certify.optimum.step_optimum`, as good as the answer.
    """
    pressed = np.flatnonzero(lam > np.maximum(slack, 0))
    basic = _basic(A[pressed], lam[pressed])
    kept = basic > 0
    order = np.argsort(-basic[kept], kind="stable")
    return [int(i) for i in pressed[kept][order]]


def basic_rows(lam: Array) -> list[int]:
    """Rows that bear more than rounding by their multipliers lam (m,) [-], the largest first."""
    bears = (lam > 0) & (lam >= ROUNDED * lam.max(initial=0.0))
    return [int(i) for i in np.argsort(-lam, kind="stable")[: np.count_nonzero(bears)]]


def _basic(A: Array, lam: Array) -> Array:
    """Multipliers >= 0 with the same A'lam, positive on linearly independent rows only.

    A block of rows after the other, each with the rows that are kept of those before it.
    """
    lam = lam.copy()
    kept = np.arange(0)
    for first in range(0, len(A), BLOCK):
        rows = np.concatenate([kept, np.arange(first, min(first + BLOCK, len(A)))])
        lam[rows] = _basic_of_block(A[rows], lam[rows])
        kept = rows[lam[rows] > 0]
    return lam


def _basic_of_block(A: Array, lam: Array) -> Array:
    """:func:`_basic` of a block of few rows, all of whose dependences are computed."""
    dependences = np.eye(len(A))
    if A.size:
        _, size, directions = np.linalg.svd(A.T)
        rank = np.count_nonzero(size > ZERO_SHARE * size[0])
        dependences = directions[rank:].T
    while dependences.shape[1]:
        d = dependences[:, 0]
        rounding = ZERO_SHARE * np.abs(d).max()
        d = d if d.max() > rounding else -d
        falling = np.flatnonzero(d > rounding)
        first = int(falling[np.argmin(lam[falling] / d[falling])])
        lam = np.maximum(lam - lam[first] / d[first] * d, 0)
        lam[first] = 0
        rest = dependences[:, 1:]
        dependences = rest - np.outer(d / d[first], rest[first])  # none uses that row again
        dependences[first] = 0
    return lam
