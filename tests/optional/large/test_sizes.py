"""The sizes of a step's terms, by hand, and the roundings of the a-priori bounds."""

from dataclasses import dataclass
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.sparse import csc_matrix

from quasistatic_ref.optional.large import sizes as of
from quasistatic_ref.optional.large.float_bound import FloatBound
from quasistatic_ref.optional.large.sizes import (
    TINY,
    rounding,
    row_sizes,
    step_sizes,
    term_sizes,
)
from quasistatic_ref.solve.units import StepInBothUnits, Units
from quasistatic_ref.step.cones import cone_function, cone_matrix
from quasistatic_ref.step.friction import scaled_by
from tests.closeness import assert_relative
from tests.helpers import random_step

CONES = ["pyramid", "product", "facets-4", "facets-8", "frictionless"]


@dataclass(frozen=True)
class Counted:
    """A number that carries how many roundings it went through; None is an exact zero.

    A number of a step has none. A sum has one more than the worse of its terms, a product one more
    than both of its factors together; multiplying by zero costs nothing.
    """

    count: int | None = 0

    def __abs__(self):
        return self

    def __add__(self, other):
        if None in (self.count, other.count):
            return other if self.count is None else self
        return Counted(1 + max(self.count, other.count))

    def __mul__(self, other):
        if None in (self.count, other.count):
            return Counted(None)
        return Counted(1 + self.count + other.count)


def counted(array):
    """The same array as numbers of a step, its zeros exact."""
    numbers = [Counted(None if v == 0 else 0) for v in np.asarray(array).ravel()]
    return np.array(numbers, dtype=object).reshape(np.shape(array))


@pytest.mark.parametrize("cone", CONES)
def test_sizes_of_rows_have_eight_roundings_at_most(cone, monkeypatch):
    """Axes 3, mu 1, cone 4: as ``ROUNDINGS`` says; A itself is a sum of fewer products."""
    step = random_step(np.random.default_rng(0)).replace(cone=cone)
    c = step.contacts
    numbers = SimpleNamespace(n=counted(c.n), d1=counted(c.d1), d2=counted(c.d2))
    monkeypatch.setattr(of, "scaled_by", lambda _: counted(scaled_by(c)))
    monkeypatch.setattr(of, "cone_matrix", lambda _: counted(cone_matrix(cone)))
    step_of_counts = SimpleNamespace(contacts=numbers, cone=cone, mask=step.mask)
    sizes = row_sizes(step_of_counts, counted(c.J))
    assert max(size.count or 0 for size in sizes.ravel()) <= 8


@pytest.mark.parametrize("terms", [0, 1, 30, 10_000, 1_000_000])
def test_a_bound_is_not_below_gamma_over_one_minus_gamma(terms):
    u = Fraction(1, 2**53)
    D = terms + 10
    gamma = D * u / (1 - D * u)
    for size in (1.0, 0.1, 3e-300, 1e300, 0.0):
        (found,) = rounding(terms, np.array([size]))
        exact = gamma / (1 - gamma) * Fraction(size)
        assert exact <= Fraction(found) <= exact * (1 + Fraction(1, 2**40)) + 2 * Fraction(TINY)


@pytest.mark.parametrize("cone", CONES)
def test_sizes_are_the_sums_of_the_sizes_of_all_terms(monkeypatch, cone):
    """Of a step in any units, as a bound of its error takes them."""
    taken = []
    monkeypatch.setattr(FloatBound, "error", lambda _, form, sizes, x, lam: taken.append(sizes))
    step = random_step(np.random.default_rng(2)).replace(cone=cone)
    both = StepInBothUnits(step)
    FloatBound(both.hessian.natural_H).step_error(both, np.zeros(step.n_v), np.zeros(step.m))
    (sizes,) = taken
    S, ell, rho = both.units
    c = step.contacts
    parts = [np.abs(axis)[:, None] @ np.abs(c.J[:, :3]) for axis in (c.n, c.d1, c.d2)]
    own = [p[:, 0] for p in parts] + [np.abs(c.J[:, 3])]
    scaled = [own[0], *(c.mu[:, i, None] * own[i + 1] for i in range(3))]
    cones = np.abs(np.stack(cone_function(cone)(*np.eye(4))))
    bar = np.einsum("ri,icv->crv", cones, scaled)[step.mask] * S / ell
    assert_relative(sizes.A, bar, 1e-14)
    spring = np.abs(step.K_q) @ np.abs(step.delta_q_bar_a) + np.abs(step.tau_a)
    load = step.h * np.concatenate([spring, np.abs(step.tau_u)]) * S / rho
    assert_relative(sizes.load, load, 1e-14)
    assert sizes.column_terms == step.mask.sum()
    assert sizes.row_terms == step.n_v
    assert sizes.usable


def test_numbers_beyond_the_largest_are_not_usable():
    step = random_step(np.random.default_rng(2))
    A = np.ones((1, step.n_v))
    one = Units(np.ones(step.n_v), 1.0, 1.0)
    assert step_sizes(step, A, one).usable
    assert not step_sizes(step, 2.0 * of.LARGEST * A, one).usable
    far = 2.0 * of.LARGEST
    # Of S, 1 / length and 1 / size one alone is too large.
    units_beyond = [
        (far, far, 1),
        (1 / far, 1 / far, 1),
        (1 / far, 1, 1 / far),
        (2.0**60, 2.0**-60, 1),
    ]
    for S, length, size in units_beyond:
        units = Units(S * one.coordinate, length, size)
        assert not step_sizes(step, A, units).usable


def test_a_sum_in_g_may_have_more_terms_than_a_column_of_A():
    sizes = term_sizes(csc_matrix([[1.0, 0.0, 2.0], [0.0, 0.0, 3.0]]), np.zeros(3))
    assert (sizes.row_terms, sizes.column_terms) == (2, 2)
    assert term_sizes(sizes.A, np.zeros(3), 5).column_terms == 5
