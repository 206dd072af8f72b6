"""Natural units lose nothing and put everything near one."""

import dataclasses

import numpy as np
import pytest

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.solve.scaled import DenseStep, check_units
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.units import (
    STANDSTILL,
    Units,
    _power_of_two,
    _typical,
    from_natural,
    metric,
    natural_form,
    natural_units,
    out_of_reach,
    to_natural,
    units_from,
    within_reach,
)
from quasistatic_ref.step.data import Extra
from quasistatic_ref.step.standard_form import standard_form
from quasistatic_ref.tolerances import FAR
from tests.helpers import (
    JUDGE,
    error,
    hessian,
    pinch,
    planted_step,
    point_on_floor,
    random_step,
    sphere_on_floor,
    unconstrained,
)
from tests.tolerances import ACTIVE_SET, EXACT, NATURAL_HIGH, NATURAL_LOW, ROUNDING

STEPS = {
    "random": random_step(np.random.default_rng(1), 7, 6, (6,) * 10 + (4,) * 5),
    "own rows": random_step(np.random.default_rng(2)).replace(
        extra=Extra(("a",), np.ones((1, 7)), [-0.3])
    ),
    "no q_a": random_step(np.random.default_rng(3), 0, 4),
    "no q_u": random_step(np.random.default_rng(4), 3, 0),
    "no contacts": random_step(np.random.default_rng(5), rows=()),
    "sphere": sphere_on_floor(wrench=(0, 0, -3, 0, 0, 0.1), phi=-1e-4),
    "pinch": pinch(),
}
every_step = pytest.mark.parametrize("step", STEPS.values(), ids=STEPS)


def inverse(units):
    """The units of a natural step that lead back to SI."""
    return Units(1 / units.coordinate, 1 / units.length, 1 / units.size)


@every_step
def test_there_and_back_gives_the_same_bits(step):
    units = natural_units(step)
    assert to_natural(to_natural(step, units), inverse(units)) == step


@every_step
def test_all_units_are_powers_of_two(step):
    units = natural_units(step)
    mantissas, _ = np.frexp([*units.coordinate, units.length, units.size])
    np.testing.assert_allclose(mantissas, 0.5, rtol=EXACT, atol=EXACT)


@every_step
def test_the_natural_diagonal_of_H_is_about_one(step):
    diagonal = np.diag(hessian(to_natural(step, natural_units(step))))
    assert diagonal.min() >= NATURAL_LOW
    assert diagonal.max() <= NATURAL_HIGH


@every_step
def test_the_typical_natural_row_is_about_one(step):
    norms = np.linalg.norm(standard_form(to_natural(step, natural_units(step))).A, axis=1)
    if norms.size:
        assert NATURAL_LOW <= np.median(norms) <= NATURAL_HIGH


@every_step
def test_the_natural_unconstrained_step_is_no_longer_than_about_one(step):
    # rho is ||H^-1 g||_H, or the push out of a penetration where that is more.
    natural = to_natural(step, natural_units(step))
    free = unconstrained(natural)
    assert np.sqrt(free @ hessian(natural) @ free) <= NATURAL_HIGH


@every_step
def test_natural_units_keep_the_form_of_13_and_4(step):
    # H' = S H S, g' = S g / rho, A' = A S / ell, b' = b / (rho ell), all exact.
    units, given = natural_units(step), standard_form(step)
    S, ell, rho = units.coordinate, units.length, units.size
    natural = standard_form(to_natural(step, units))
    np.testing.assert_allclose(natural.H, given.H * np.outer(S, S), rtol=EXACT, atol=EXACT)
    np.testing.assert_allclose(natural.b, given.b / (rho * ell), rtol=EXACT, atol=EXACT)
    np.testing.assert_allclose(natural.A, given.A * S / ell, rtol=ROUNDING, atol=EXACT)
    np.testing.assert_allclose(natural.g, given.g * S / rho, rtol=ROUNDING, atol=EXACT)


def test_mu_omega_and_the_frames_are_left_alone():
    step = STEPS["random"]
    natural = to_natural(step, natural_units(step))
    assert natural.h == step.h
    for name in ("n", "d1", "d2", "mu_v", "mu_omega", "rows"):
        np.testing.assert_allclose(
            getattr(natural.contacts, name), getattr(step.contacts, name), rtol=EXACT, atol=EXACT
        )


@pytest.mark.parametrize("seed", range(5))
def test_the_answer_does_not_depend_on_the_units(seed):
    # Solve in natural units, and in units spoilt by powers of two per coordinate; compare in SI.
    rng = np.random.default_rng(seed)
    step, delta_q, lam = planted_step(rng)
    units = natural_units(step)
    spoilt = Units(
        units.coordinate * 2.0 ** rng.integers(-2, 3, 7), units.length * 4, units.size / 2
    )
    for chosen in (units, spoilt):
        answer = solve_step(to_natural(step, chosen), JUDGE)
        back, impulses = from_natural(answer.delta_q, answer.lam, chosen)
        np.testing.assert_allclose(error(step, back, delta_q), 0.0, rtol=0.0, atol=ACTIVE_SET)
        np.testing.assert_allclose(impulses, lam, rtol=0.0, atol=ACTIVE_SET * lam.max())


def test_a_power_of_two_in_the_data_moves_the_units_and_nothing_else():
    # Twice the motion and force: the natural step is the same, bit for bit.
    step = STEPS["random"]
    contacts = dataclasses.replace(step.contacts, phi=2 * step.contacts.phi)
    twice = step.replace(
        tau_a=2 * step.tau_a,
        tau_u=2 * step.tau_u,
        delta_q_bar_a=2 * step.delta_q_bar_a,
        contacts=contacts,
    )
    one, two = natural_units(step), natural_units(twice)
    assert two.size == 2 * one.size
    assert to_natural(twice, two) == to_natural(step, one)


def test_a_step_without_force_or_gap_has_units_too(rng):
    still = random_step(rng, rows=()).replace(
        tau_a=np.zeros(3), tau_u=np.zeros(4), delta_q_bar_a=np.zeros(3)
    )
    assert natural_units(still).size == STANDSTILL
    np.testing.assert_allclose(solve_step(still).delta_q, 0.0, rtol=0.0, atol=ROUNDING)


@pytest.mark.parametrize("depth", [1e-3, 1.0])
def test_a_deep_penetration_sets_the_size_where_the_load_is_small(depth):
    # ||H^-1 g||_H is nearly 0 here: without the push out, b' would be as large as depth / 0.
    natural = sphere_on_floor(phi=-depth, wrench=(0, 0, -1e-9, 0, 0, 0))
    natural = to_natural(natural, natural_units(natural))
    assert NATURAL_LOW <= abs(natural.contacts.phi[0]) <= NATURAL_HIGH


@pytest.mark.parametrize("backend_name", ["clarabel", "osqp", "piqp"])
def test_a_body_that_nothing_drives_stays_where_it_is(backend_name):
    delta_q = solve_step(sphere_on_floor(phi=0.0), backend_name).delta_q
    np.testing.assert_allclose(delta_q, 0.0, rtol=0.0, atol=ROUNDING)


def test_a_gap_sets_the_size_where_nothing_else_does():
    step = sphere_on_floor(phi=0.02)
    natural = to_natural(step, natural_units(step))
    assert NATURAL_LOW <= natural.contacts.phi[0] <= NATURAL_HIGH


def test_contacts_out_of_reach_are_moved_nearer_and_the_others_are_not():
    step = sphere_on_floor(phi=0.0, wrench=(0, 0, -1.0, 0, 0, 0))
    natural = to_natural(step, natural_units(step))
    assert within_reach(natural) is natural
    far = natural.replace(contacts=dataclasses.replace(natural.contacts, phi=np.array([1e9])))
    reach = FAR * max(1.0, np.linalg.norm(natural.contacts.J[0]))
    np.testing.assert_allclose(within_reach(far).contacts.phi, [reach], rtol=ROUNDING, atol=0.0)
    assert out_of_reach(far).all()
    assert not out_of_reach(within_reach(far)).any()


@every_step
def test_the_natural_form_is_that_of_the_natural_step_bit_for_bit(step):
    units, form = natural_units(step), standard_form(step)
    expected = standard_form(to_natural(step, units))
    for found, value in zip(natural_form(form, units), expected, strict=True):
        np.testing.assert_array_equal(found, value)
    assert natural_form(form, units, H := np.eye(step.n_v)).H is H


@pytest.mark.parametrize(
    ("lengths", "median"),
    [([], 1), ([0, 0], 1), ([3], 3), ([0, 0, 2, 4, 9], 4), ([0, 2, 4], 3), ([2, 4, 9], 4)],
)
def test_the_typical_length_is_the_median_of_rows_that_are_not_zero(lengths, median):
    assert _typical(np.square(np.array(lengths, float))) == median


def test_sizes_that_are_no_positive_finite_number_have_no_unit():
    """Of a step without penetration the size is the power of two nearest to its length, here 3."""
    for x in (0.0, np.inf, np.nan, -1.0):
        assert np.isnan(_power_of_two(x))
    assert _power_of_two(1.7e308) == np.inf  # the nearest power is 2^1024
    assert _power_of_two(3.0) == 4.0
    with np.errstate(all="ignore"):
        assert not metric(np.diag([1.0, np.inf])).usable
    S, b = np.ones(1), np.zeros(2)
    assert units_from(S, np.array([1.0, 1.0]), 3.0, b).size == 4.0
    assert np.isnan(units_from(S, np.array([1.0, 1.0, np.inf]), 3.0, b).size)


def test_units_that_are_not_finite_and_positive_are_refused():
    step, units = STEPS["sphere"], natural_units(STEPS["sphere"])
    check_units(units, step)
    for name in ("length", "size"):
        for bad in (0.0, np.inf, np.nan):
            with pytest.raises(StepDataError, match="range of float64"):
                check_units(units._replace(**{name: bad}), step)


def test_rows_are_as_unlike_as_the_longest_and_the_shortest_not_of_zeros():
    """H is a multiple of the identity. Without friction the rows of a contact are n, of length 1.

    Own rows have lengths 5, 0.5 and 0.
    """
    own = Extra(("a", "b", "c"), [[0.0, 3, 4], [0.3, 0.4, 0], [0, 0, 0]], [0.0] * 3)
    step = point_on_floor(mu_v=0.0)
    assert DenseStep(step).unlike == 1.0
    assert DenseStep(step.replace(extra=own)).unlike == pytest.approx(5 / 0.5, rel=ROUNDING)
    assert DenseStep(STEPS["no contacts"]).unlike == 1.0
