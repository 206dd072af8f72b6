"""The proof of a right guess: what float64 claims is true, and every sign and rounding is exact."""

import itertools
import tracemalloc

import numpy as np
import pytest
from flint import arb_mat

from quasistatic_ref import Extra
from quasistatic_ref.certify.form import EXACT, StepForm, exact_matrix
from quasistatic_ref.certify.minimiser import Minimiser
from quasistatic_ref.certify.working_set import NearSets, ball_point
from quasistatic_ref.numbers.dependence import implied, independent_rows
from quasistatic_ref.numbers.precision import working_precision
from tests.helpers import resting_point
from tests.oracles.forms import exact_form_of
from tests.oracles.random_steps import any_step

LEAST = 5e-324


def exact_slacks(form, x):
    """All slacks at a float64 x, without rounding."""
    with working_precision(EXACT):
        z = exact_matrix(np.append(x, 1.0)[:, None])
        return (arb_mat(form.exact_rows(range(form.m))) * z).entries()


def scaled(step, rng, power):
    """The step with entries of J, phi, mu and own rows times random powers of ten."""
    c = step.contacts

    def spread(v):
        with np.errstate(over="ignore", under="ignore"):
            wide = v * 10.0 ** rng.integers(-power, min(power, 307) + 1, v.shape)
        return np.clip(wide, -1e308, 1e308)

    changed = type(c)(
        c.name, spread(c.phi), c.n, c.d1, c.d2, spread(c.J), np.abs(spread(c.mu_v)),
        np.abs(spread(c.mu_omega)), c.rows,
    )  # fmt: skip
    own = Extra(("a", "b"), spread(rng.standard_normal((2, step.n_v))), spread(np.ones(2)))
    return step.replace(contacts=changed, extra=own)


@pytest.mark.parametrize("cone", ["pyramid", "product", "facets-6", "frictionless"])
@pytest.mark.parametrize("power", [0, 150, 323])
def test_slacks_of_float64_are_off_by_no_more_than_their_bounds(cone, power):
    """With entries from subnormal ones to the largest; where products overflow nothing is said."""
    rng = np.random.default_rng(power)
    claims = 0
    for size in (0.0, LEAST, 1e-300, 1e-9, 1.0, 1e150, 1e300):
        step = scaled(any_step(rng, 3, 6, 5, 1e3).replace(cone=cone), rng, power)
        form = StepForm(step)
        x = size * rng.standard_normal(form.n)
        with np.errstate(all="ignore"):
            slack, error = form.float_slacks(x, np.abs(x) + 1e-290)
        for s, e, exact in zip(slack, error, exact_slacks(form, x), strict=True):
            if np.isfinite(s) and np.isfinite(e):
                with working_precision(EXACT):
                    assert abs(exact - float(s)) <= float(e)
            if s > e:
                claims += 1
                assert exact > 0
    assert claims


@pytest.mark.parametrize("cone", ["pyramid", "product", "facets-6", "frictionless"])
def test_rows_that_a_cone_implies_are_those_that_elimination_finds(cone):
    """Of one contact, whose four lengths are independent: no rows imply more than its cone."""
    step = resting_point().replace(cone=cone)
    form = StepForm(step)
    of_contact = range(int(step.counts[0]))
    for size in range(5):
        for working in itertools.combinations(of_contact, size):
            if independent_rows(form, working) != working:
                continue
            shown = implied(form.integers(working), form.integers(of_contact))
            right = [i for i, is_implied in zip(of_contact, shown, strict=True) if is_implied]
            assert form.implied_by_cone(working, of_contact) == right
            assert Minimiser(form, working).implied(of_contact) == right


def test_balls_that_hide_x_are_formed_again():
    """What rows (1, 0) and (1, 2^-150) say of another set loses 300 of 320 bits."""
    A = np.array([[1.0, 0.0], [1.0, 2.0**-150], [0.0, 1.0]])
    form = exact_form_of(np.eye(2), np.array([-1.0, 1.0]), A, np.array([1.0, 2.0, 3.0]))
    near = NearSets(form, (0, 1))
    minimiser = Minimiser(form, (1, 2), near)
    _, radius = ball_point(form, (1, 2), near).floats
    _, formed_again = minimiser.balls.floats
    assert radius.max() > 1e-6
    assert formed_again.max() < 1e-90
    assert minimiser.near_sets is not near


def test_a_guess_of_sums_takes_memory_by_the_rows_that_come_near():
    """Ten thousand violated rows once took a square of them, 22 gigabytes for a scanned fly."""
    angle = np.linspace(0.1, 3.0, 10_000)
    A = np.column_stack([np.cos(angle), np.sin(angle)])
    form = exact_form_of(np.eye(2), np.zeros(2), A, np.ones(len(A)))
    minimiser = Minimiser(form, (0,))
    tracemalloc.start()
    doubtful = minimiser.doubtful(range(1, len(A)))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert len(doubtful) == len(A) - 1
    assert peak < 1e8
