"""The roundings of the a-priori bounds, counted by numbers that carry how many they went through.

A number of a step has none. A sum has one more than the worse of its terms, a product one more
than both of its factors together; multiplying by zero, one or a unit costs nothing.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.sparse import csc_matrix

from quasistatic_ref.optional.large import sizes as of
from quasistatic_ref.optional.large.float_bound import FloatBound
from quasistatic_ref.optional.large.sizes import (
    ROUNDINGS,
    TINY,
    UNIT,
    TermSizes,
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
    """So many roundings; None is an exact zero."""

    count: int | None = 0

    def __abs__(self):
        return self

    __neg__ = __abs__

    def __add__(self, other):
        other = other if isinstance(other, Counted) else Counted(None if other == 0 else 0)
        if None in (self.count, other.count):
            return other if self.count is None else self
        return Counted(1 + max(self.count, other.count))

    __sub__ = __radd__ = __rsub__ = __add__

    def __mul__(self, other):
        if not isinstance(other, Counted):  # a unit, a power of two
            return self
        if None in (self.count, other.count):
            return Counted(None)
        return Counted(1 + self.count + other.count)

    __rmul__ = __mul__


def counted_numbers(array):
    """The same array as numbers of a step, its zeros exact."""
    numbers = [Counted(None if v == 0 else 0) for v in np.asarray(array).ravel()]
    found = np.empty(len(numbers), dtype=object)
    found[:] = numbers
    return found.reshape(np.shape(array))


def most(values):
    return max(v.count or 0 for v in np.ravel(values))


def counted_sizes(cone, monkeypatch, n_c=2):
    """Sizes of a step whose numbers are counted, and x and lam that are."""
    step = random_step(np.random.default_rng(0), rows=(6,) * n_c).replace(cone=cone)
    c = step.contacts
    numbers = SimpleNamespace(
        n=counted_numbers(c.n), d1=counted_numbers(c.d1), d2=counted_numbers(c.d2), mu=c.mu
    )
    monkeypatch.setattr(of, "scaled_by", lambda _: counted_numbers(scaled_by(c)))
    monkeypatch.setattr(of, "cone_matrix", lambda _: counted_numbers(cone_matrix(cone)))
    posed = SimpleNamespace(contacts=numbers, cone=cone, present=step.present)
    A = row_sizes(posed, counted_numbers(c.J))
    m, n_v = A.shape
    return (
        TermSizes(A, np.zeros(n_v), n_v, m, True),
        counted_numbers(np.ones(n_v)),
        counted_numbers(np.ones(m)),
    )


def entry(cone):
    """Roundings of an entry of A: products with three axes, mu, and the cone's own sum."""
    part = reduce(lambda a, b: a + b, [Counted() * Counted()] * 3)
    mu = Counted()
    corners = type("Corner", (Counted,), {})
    slip = [mu * part, mu * part, mu * Counted()]
    rows = cone_function(cone)
    if cone.startswith("facets"):  # whose cosines and sines are numbers of the step, too
        K = int(cone.partition("-")[2])
        sides = part + corners() * slip[0] + corners() * slip[1]
        assert len(rows(part, *slip)) == K + 2
        return max(sides.count, (part + slip[2]).count)
    return max(row.count for row in rows(part, *slip))


@pytest.mark.parametrize("cone", CONES)
def test_no_result_has_more_roundings_than_its_bound_allows(cone, monkeypatch):
    for n_c in (1, 2, 5):
        sizes, x, lam = counted_sizes(cone, monkeypatch, n_c)
        rows = sizes.row_terms + ROUNDINGS
        columns = sizes.column_terms + ROUNDINGS
        assert most(sizes.rows(x)) + 1 <= rows  # and |b| is added
        assert most(sizes.columns(lam)) + 2 <= columns  # and the sizes of H x and g are
        a = entry(cone)
        assert a + 1 + (sizes.row_terms - 1) + 1 <= rows  # A x - b
        assert a + 1 + (sizes.column_terms - 1) + 2 <= columns  # H x - g - A'lam


def test_the_unit_is_the_largest_relative_error_of_one_operation():
    exact = Fraction(1) + Fraction(1, 2**53)
    lost = exact - Fraction(1.0 + 2.0**-53)
    assert lost / exact <= Fraction(UNIT) < 2 * lost


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
    for S, length, size in (
        (far, 1.0, 1.0), (1.0, 1 / far, 1.0), (1.0, 1.0, 1 / far),
        # One alone of 1 / length, 1 / size and S / length is too large.
        (1 / far, 1 / far, 1.0), (1 / far, 1.0, 1 / far), (2.0**60, 2.0**-60, 1.0),
    ):  # fmt: skip
        units = Units(S * one.coordinate, length, size)
        assert not step_sizes(step, A, units).usable


def test_a_sum_in_g_may_have_more_terms_than_a_column_of_A():
    sizes = term_sizes(csc_matrix([[1.0, 0.0, 2.0], [0.0, 0.0, 3.0]]), np.zeros(3))
    assert (sizes.row_terms, sizes.column_terms) == (2, 2)
    assert term_sizes(sizes.A, np.zeros(3), 5).column_terms == 5
