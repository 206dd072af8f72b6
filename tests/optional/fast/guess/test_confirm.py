"""A guessed working set, confirmed in balls: the bits of the exact method, or None."""

import numpy as np
import pytest
from flint import arb

from quasistatic_ref.certify.exact import form_optimum, step_optimum
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.lab.scenes.contacts import contacts_of, no_contacts
from quasistatic_ref.lab.scenes.grasps import aligned_grasp_step, grasp_step
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.optional.fast.compiled import why_not
from quasistatic_ref.optional.fast.guess.confirm import BallHessian, BallStep, all_nearest
from quasistatic_ref.optional.fast.guess.zeros import Degeneracy, zeros
from quasistatic_ref.step.data import Extra
from quasistatic_ref.step.standard_form import linear_term
from tests.certify.test_exact import resting_point
from tests.helpers import pinch, planted_step, random_step, sphere_on_floor
from tests.tolerances import ROUNDING
from validation.make import confirmed_bits
from validation.make.confirmed_bits import CONES, checked, differing

FLOOR_OWN = Extra(("stop", "far"), [[1.0, 0, 0, 0, 0, 0, 0], [0, 1.0, 0, 0, 0, 0, 0]], [1e-4, -1.0])


def optimum_and_answer(step, guess=None):
    """What the exact method makes of a guess, its own working set by default, and what is new."""
    form = exact_form(step)
    truth = form_optimum(form, () if guess is None else guess)
    given = truth.working_set if guess is None else guess
    return form_optimum(form, given), BallStep(step, BallHessian(step)).confirmed(given)


def some_steps():
    rng = np.random.default_rng(3)
    yield "grasp", grasp_step(rng)
    yield "aligned grasp", aligned_grasp_step(rng)
    # Four independent rows hold it: A'lam = -g, whose entries are ties and short numbers.
    yield "body held", resting_point(h=0.01).replace(tau_u=[0.1, 0.07, -3.0, 0.01])
    yield "planted", planted_step(rng)[0]
    yield "rows of a user's own", random_step(rng).replace(extra=FLOOR_OWN)
    # Here x is zero by symmetry, or because nothing pushes.
    yield "pinch", pinch()
    yield "sphere", sphere_on_floor(wrench=(0.5, 0.0, -3.0, 0.0, 0.0, 0.01))
    yield "no contact", random_step(rng).replace(contacts=no_contacts(7))


STEPS = dict(some_steps())


def test_an_inverse_is_kept_for_the_same_h_and_matrices_alone():
    step = STEPS["grasp"]
    hessian = BallHessian(step)
    assert hessian.fits(step)
    for other in ({"h": 2 * step.h}, {"K_q": 2 * step.K_q}, {"M_u": 2 * step.M_u}):
        assert not hessian.fits(step.replace(**other))


def test_the_net_impulse_is_that_of_the_force_balance():
    """H delta_q - g of Eq. (9)."""
    rng = np.random.default_rng(4)
    step = random_step(rng)
    delta_q = rng.normal(size=step.n_v)
    net = BallHessian(step).net(step, [arb(v) for v in delta_q.tolist()])
    expected = step.H @ delta_q - linear_term(step)
    size = np.abs(step.H) @ np.abs(delta_q) + np.abs(linear_term(step))
    assert np.abs(step.tau_a).min() > 0
    np.testing.assert_array_less(np.abs([float(v) for v in net] - expected), ROUNDING * size)


X = 1 + 2.0**-52
"""An odd number: of a tie next to it, the other number is the nearest."""


@pytest.mark.parametrize(
    ("ball", "nearest"),
    [
        (arb(0), 0.0),
        (arb(0, 1e-3), None),
        (-(arb(2) ** -1100), 0.0),
        (arb(X), X),
        (arb(X, 2.0**-54), X),
        (arb(X, 2.0**-53), None),  # half of the distance to its neighbours
        (arb(X, 2.0**-52), None),
    ],
)
def test_a_number_is_shown_to_be_nearest_only_to_all_of_its_ball(ball, nearest):
    found, shown = all_nearest([ball])
    assert shown.tolist() == [nearest is not None]
    if nearest is not None:
        assert found.tobytes() == np.array([nearest]).tobytes()


@pytest.mark.parametrize("step", STEPS.values(), ids=STEPS)
def test_the_right_working_set_is_confirmed_with_the_same_bits(step):
    truth, answer = optimum_and_answer(step)
    assert answer is not None
    assert differing(answer, truth) == []


def held_point(*bounds):
    """H = 1, a force along y, a floor at z = -1e-3, and own rows a'x >= b: (axis, b) of each."""
    floor = contacts_of(1e-3, np.eye(3)[None], np.eye(4, 3)[None], 0.0)
    names = tuple(f"row {i}" for i in range(len(bounds)))
    own = Extra(names, np.eye(3)[[axis for axis, _ in bounds]], [b for _, b in bounds])
    step = free_step(np.eye(3), (0.0, 5.0, -9.0), floor, 1.0)
    return step.replace(cone="frictionless", extra=own)


@pytest.mark.parametrize(
    ("bounds", "rows", "coordinates", "expected"),
    [
        # W: the floor, and x >= 0. A copy of each row follows from W, and the coordinate x.
        ([(0, 0.0), (2, -1e-3), (0, 0.0)], (2, 3), (0,), Degeneracy(False, True, implied=True)),
        # z >= -2e-3 has a slack of 1e-3, wherever it stands among the rows.
        ([(0, 0.0), (2, -2e-3), (0, 0.0)], (2, 3), (), None),
        ([(0, 0.0), (0, 0.0), (2, -2e-3)], (2, 3), (), None),
        # y is pushed, z is not zero.
        ([(0, 0.0)], (), (1,), None),
        ([(0, 0.0)], (), (2,), None),
        # y >= 5: nothing is left, because of the force alone.
        ([(0, 0.0), (1, 5.0)], (2,), (), Degeneracy(True, False)),
    ],
)
def test_what_is_zero_is_told_from_what_is_not(bounds, rows, coordinates, expected):
    assert zeros(held_point(*bounds), (0, 1), rows, coordinates) == expected


def test_random_steps_have_the_same_bits_and_wrong_sets_are_refused():
    """A sample of validation/make/confirmed_bits.py."""
    outcomes = [checked(seed) for seed in range(6 * len(CONES))]
    assert [faults for _, _, faults in outcomes if faults] == []
    total = {key: sum(found[key] for _, found, _ in outcomes) for key in confirmed_bits.COLUMNS}
    assert total["optima"] >= 24
    assert total["confirmed"] >= 0.95 * total["optima"]
    assert total["compiled"] > 0.9 * total["optima"] or why_not() is not None
    assert total["refused"] >= 50


def test_a_row_that_touches_and_bears_nothing_is_a_kink():
    step = resting_point(weight=0.0)
    truth, answer = optimum_and_answer(step)
    assert not truth.differentiable
    assert differing(answer, truth) == []
    assert differing(step_optimum(step, truth.working_set), truth) == []


def test_rows_that_depend_on_each_other_are_refused():
    """All six of a contact that sticks have rank four."""
    step = sphere_on_floor(wrench=(0.0, 0.0, -3.0, 0.0, 0.0, 0.0))
    assert BallStep(step, BallHessian(step)).confirmed(range(6)) is None
