"""Natural units lose nothing and put everything near one."""

import dataclasses

import numpy as np
import pytest

from quasistatic_ref import Extra, StepDataError, solve_step, standard_form, verify
from quasistatic_ref.step.standard_form import OUT_OF_REACH, clipped_gaps
from tests.cases import cases
from tests.closeness import assert_relative, assert_same
from tests.helpers import (
    PAPER,
    pinch,
    random_step,
    sphere_on_floor,
)
from tests.made import bits, free_step, no_contacts
from tests.oracles.random_steps import smaller
from tests.solvers import NaturalStep
from tests.tolerances import NATURAL_HIGH, NATURAL_LOW


def own_row(entry):
    return Extra(("a",), np.full((1, 7), entry), [-0.3])


STEPS = {
    "random": random_step(1, *PAPER),
    "own rows": random_step(2).replace(extra=own_row(1.0)),
    "own rows alone": random_step(2, rows=()).replace(extra=own_row(64.0)),
    "no q_a": random_step(3, 0, 4),
    "no q_u": random_step(4, 3, 0),
    "no contacts": random_step(5, rows=()),
    "sphere": sphere_on_floor(wrench=(0, 0, -3, 0, 0, 0.1), phi=-1e-4),
    "pinch": pinch(),
}
every_step = cases("step", STEPS)


@every_step
def test_units_are_powers_of_two_and_put_everything_near_one(step):
    units = NaturalStep(step).units
    mantissas, _ = np.frexp([*units.coordinate, units.length, units.size])
    assert_same(mantissas, 0.5)
    natural = NaturalStep(step).form
    assert NATURAL_LOW <= np.diag(natural.H).min() <= np.diag(natural.H).max() <= NATURAL_HIGH
    lengths = np.linalg.norm(natural.A, axis=1)
    assert not lengths.size or NATURAL_LOW <= np.median(lengths) <= NATURAL_HIGH
    # rho is ||H^-1 g||_H, or the push out of a penetration where that is more.
    free = np.linalg.solve(natural.H, natural.g)
    assert np.sqrt(free @ natural.g) <= NATURAL_HIGH


@every_step
def test_natural_units_keep_the_form_of_13_and_4(step):
    """The form of the step whose fields are in natural units is the form in these units."""
    scaled = NaturalStep(step)
    assert bits(standard_form(step_in_units(step, scaled.units))) == bits(scaled.form)


def step_in_units(step, units):
    """A step with each field in other units: delta_q = rho S x, lengths in units of rho ell."""
    S, ell, rho = units
    S_a, S_u = np.split(S, [step.n_a])
    c = step.contacts
    own = step.extra
    return step.replace(
        K_q=step.K_q * np.outer(S_a, S_a),
        M_u=step.M_u * np.outer(S_u, S_u),
        tau_a=step.tau_a * S_a / rho,
        tau_u=step.tau_u * S_u / rho,
        delta_q_bar_a=step.delta_q_bar_a / (rho * S_a),
        contacts=dataclasses.replace(c, phi=c.phi / (rho * ell), J=c.J * (S / ell)),
        extra=dataclasses.replace(own, A=own.A * (S / ell), b=own.b / (rho * ell)),
    )


@pytest.mark.parametrize("power", [2.0, 2.0**-900])
def test_a_power_of_two_in_the_data_moves_the_units_and_nothing_else(power):
    # More motion and force, or so little that its square is 0: the natural form has the same bits.
    step = STEPS["random"]
    one, two = NaturalStep(step), NaturalStep(smaller(step, power))
    assert two.units.size == power * one.units.size
    assert bits(two.form) == bits(one.form)


def with_own_rows(rows, b):
    """A step with H = M / h = 1, so that rows are as long as they look."""
    own = Extra(tuple(map(str, range(len(rows)))), np.array(rows), np.array(b))
    return free_step(np.eye(2) / 2, np.zeros(2), no_contacts(2), 0.5).replace(extra=own)


@pytest.mark.parametrize(
    ("rows", "length"), [([[2, 0]], 2.0), ([[0, 0], [1, 0]], 1.0), ([[0, 0]], 1.0)]
)
def test_rows_in_which_nothing_moves_have_no_say_in_the_length(rows, length):
    step = with_own_rows(rows, [-1.0] * len(rows))
    assert NaturalStep(step).units.length == length
    assert NaturalStep(step).row_ratio == 1.0


def test_without_load_and_penetration_the_size_is_a_length_that_counts_as_unmoved():
    """Of the softest coordinate, however far the rows are: one micrometre, to a power of two."""
    step = with_own_rows([[64, 0], [0, 64]], [-0.5, -32.0])
    coordinate, length, size = NaturalStep(step).units
    assert (coordinate.tolist(), length) == ([1.0, 1.0], 64.0)
    assert size == 2.0**-20
    assert NaturalStep(with_own_rows(np.zeros((0, 2)), [])).units.size == size


@pytest.mark.parametrize("h", [1e-2, 1e-4])
@pytest.mark.parametrize("backend", ["daqp", "clarabel"])
def test_an_unproved_answer_ends_at_a_users_wall(backend, h):
    """A proof would mend a wall in other units: 20 N push 1 kg to it, x = 1e-6 m (h / 0.01 s)^2."""
    end = 1e-6 * (h / 1e-2) ** 2
    push = sphere_on_floor(m=1.0, mu_v=0.1, wrench=(20.0, 0, -9.81, 0, 0, 0), h=h)
    step = push.replace(extra=Extra(("wall",), -np.eye(6)[:1], [-end]))
    assert_relative(solve_step(step, backend, certify="off").delta_q[0], end, 1e-6)


@pytest.mark.parametrize("depth", [1e-3, 1.0])
def test_a_deep_penetration_sets_the_size_where_the_load_is_small(depth):
    # ||H^-1 g||_H is nearly 0 here: without the push out, b' would be as large as depth / 0.
    natural = NaturalStep(sphere_on_floor(phi=-depth, wrench=(0, 0, -1e-9, 0, 0, 0))).form
    assert NATURAL_LOW <= natural.b[0] <= NATURAL_HIGH


def test_contacts_and_rows_out_of_reach_are_moved_nearer_and_the_others_are_not():
    walls = Extra(("near", "far"), np.eye(6)[[0, 2]], np.array([-1e-3, -1e9]))
    step = sphere_on_floor(phi=1e9, wrench=(0, 0, -1.0, 0, 0, 0)).replace(extra=walls)
    scaled = NaturalStep(step)
    natural = step_in_units(step, scaled.units)
    unit = scaled.units.size * scaled.units.length
    phi, b = (ends / unit for ends in clipped_gaps(step, scaled.units))
    assert_relative(phi, [OUT_OF_REACH * max(1.0, np.linalg.norm(natural.contacts.J[0]))])
    own = OUT_OF_REACH * max(1.0, np.linalg.norm(natural.extra.A[1]))
    assert_relative(b, [natural.extra.b[0], -own])
    assert scaled.out_of_reach.tolist() == [True] * (step.m - 2) + [False, True]
    form = scaled.within_reach
    assert_same(form.A, scaled.form.A)
    assert_same(form.b, [*-np.repeat(phi, step.m - 2), *b])
    assert_same(clipped_gaps(step, scaled.units, np.inf)[0], step.contacts.phi)


def test_a_step_beyond_natural_units_is_proved_without_a_backend_and_has_no_residuals():
    """Its floor is 1e300 m away, and a load of 1e-250 N moves it by h^2 tau / m."""
    step = sphere_on_floor(phi=1e300, wrench=(0, 0, -1e-250, 0, 0, 0))
    with pytest.raises(StepDataError, match="exceed the range of float64"):
        solve_step(step)
    solution = solve_step(step, "none")
    assert solution.delta_q[2] == -(step.h**2) * 1e-250 / step.M_u[0, 0]
    assert solution.certificate.residuals == {}
    assert verify(solution)
