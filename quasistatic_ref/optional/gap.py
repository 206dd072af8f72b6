r"""How far multipliers are from optimal ones: the duality gap, without rounding.

For an x that satisfies all constraints and a lam in the dual cone, weak duality gives

.. math:: f(x^*) - d(\lambda) \le f(x) - d(\lambda)
          = \tfrac12\|H x - g - A^T\lambda\|_{H^{-1}}^2 + \lambda^T (A x - b),

with equality at x = x*. The first term is what lam leaves unbalanced (Eq. :eq:`eq-9`), the second
is complementarity (Eq. :eq:`eq-12`): a force where nothing touches cannot hide in it.
"""

import math
from collections.abc import Sequence

from flint import arb, arb_mat, fmpq, fmpq_mat

from quasistatic_ref.exact.program import ExactProgram, fraction
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import all_nearest


def fractions(values: Array) -> list[fmpq]:
    """Float64 numbers as fractions, without rounding.

    Parameters
    ----------
    values : ndarray, shape (k,)
        Finite [any unit].
    """
    return [fraction(v) for v in values.tolist()]


def rational(M: arb_mat) -> fmpq_mat:
    """A matrix of exact numbers in fractions [any unit]."""
    return fmpq_mat(M.nrows(), M.ncols(), [fraction(v) for v in M.entries()])


def nearest_in(ball: arb) -> float | None:
    """The float64 nearest to every number in a ball [its unit]; None if it has none."""
    nearest = all_nearest([ball])
    return None if nearest is None else nearest[0]


def lagrangian_minimiser(form: ExactProgram, lam: Sequence[fmpq]) -> fmpq_mat:
    """The x of H x = g + A'lam [m, rad], shape (n, 1); lam in [N s], of length m."""
    push = rational(form.A).transpose() * fmpq_mat(form.m, 1, list(lam))
    return rational(form.H).solve(rational(form.g) + fraction(form.h) * push)


def energy(form: ExactProgram, x: Sequence[fmpq]) -> fmpq:
    """1/2 ||x||_H^2 [N m s], x in [m, rad]."""
    column = fmpq_mat(form.n, 1, list(x))
    product = column.transpose() * rational(form.H) * column
    return sum(product.entries(), fmpq(0)) / (2 * fraction(form.h))


def free_energy(form: ExactProgram) -> fmpq:
    """1/2 ||H^-1 g||_H^2 [N m s]."""
    return energy(form, lagrangian_minimiser(form, [fmpq(0)] * form.m).entries())


def duality_gap(form: ExactProgram, x: Sequence[fmpq], lam: Sequence[fmpq]) -> fmpq:
    """f(x) - d(lam) of an x that satisfies all constraints and a lam in the dual cone.

    Parameters
    ----------
    form : ExactProgram
    x : sequence of fmpq, length n_v
        [m, rad].
    lam : sequence of fmpq, length m
        [N s].

    Returns
    -------
    fmpq
        [N m s].
    """
    column = fmpq_mat(form.n, 1, list(x))
    off = column - lagrangian_minimiser(form, lam)
    slack = rational(form.A) * column + rational(form.c)
    work = sum((v * s for v, s in zip(lam, slack.entries(), strict=True)), fmpq(0))
    return energy(form, off.entries()) + work


def inner(u: arb_mat, v: arb_mat) -> arb:
    """Inner product u'v of two columns (n, 1) [product of their units]."""
    return (u.transpose() * v)[0, 0]


def square_root(square: arb) -> arb:
    """The square root of what is not negative, whatever a ball about it holds."""
    return square.nonnegative_part().sqrt()


def nearest_above(ball: arb) -> float:
    """A float64 that no number in a ball exceeds [of the unit of the ball]."""
    top = ball.upper()
    if not top.is_finite():
        return float("inf")
    return math.nextafter(float(top), math.inf) if top != 0 else 0.0
