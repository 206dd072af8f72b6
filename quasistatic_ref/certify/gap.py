r"""How far multipliers are from optimal ones: the duality gap, without rounding.

For an x that satisfies all constraints and a lam in the dual cone, weak duality gives

.. math:: f(x^*) - d(\lambda) \le f(x) - d(\lambda)
          = \tfrac12\|H x - g - A^T\lambda\|_{H^{-1}}^2 + \lambda^T (A x - b),

with equality at x = x*. The first term is what lam leaves unbalanced (Eq. :eq:`eq-9`), the second
is complementarity (Eq. :eq:`eq-12`): a force where nothing touches cannot hide in it.
"""

from collections.abc import Sequence

from flint import fmpq, fmpq_mat

from quasistatic_ref.certify.rational import ExactForm, fraction
from quasistatic_ref.step.data import Array


def fractions(values: Array, unit: fmpq) -> list[fmpq]:
    """Float64 numbers in a unit, without rounding [-].

    Parameters
    ----------
    values : ndarray, shape (k,)
        Finite [those of the unit].
    unit : fmpq
    """
    return [fraction(v) / unit for v in values.tolist()]


def duality_gap(form: ExactForm, x: Sequence[fmpq], lam: Sequence[fmpq]) -> fmpq:
    """f(x) - d(lam) of an x that satisfies all constraints and a lam in the dual cone.

    Parameters
    ----------
    form : ExactForm
    x : sequence of fmpq, length n_v
        In the form's units.
    lam : sequence of fmpq, length m
        In the form's units.

    Returns
    -------
    fmpq
        In the form's units of energy, ``net_unit * x_unit`` [N m s].
    """
    column = fmpq_mat(form.n, 1, list(x))
    push = fmpq_mat(1, form.m, list(lam))
    A = fmpq_mat(form.A)
    off = fmpq_mat(form.H) * column - fmpq_mat(form.g) - A.transpose() * push.transpose()
    work = push * (A * column - fmpq_mat(form.b))
    return _squared(form, off) / 2 + sum(work.entries(), fmpq(0))


def free_energy(form: ExactForm) -> fmpq:
    """1/2 ||H^-1 g||_H^2, in the form's units of energy [N m s]."""
    return _squared(form, fmpq_mat(form.g)) / 2


def energy(form: ExactForm, x: Sequence[fmpq]) -> fmpq:
    """1/2 ||x||_H^2, in the form's units of energy [N m s]."""
    column = fmpq_mat(form.n, 1, list(x))
    return sum((column.transpose() * fmpq_mat(form.H) * column).entries(), fmpq(0)) / 2


def _squared(form: ExactForm, impulse: fmpq_mat) -> fmpq:
    """Return ||p||^2 in the norm of H^-1."""
    moved = fmpq_mat(form.H).solve(impulse)
    return sum((impulse.transpose() * moved).entries(), fmpq(0))
