"""A guessed working set, confirmed in balls: the bits of the exact method, or None."""

import numpy as np
import pytest

from quasistatic_ref.certify.exact import form_optimum, step_optimum
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.lab.scenes.contacts import no_contacts
from quasistatic_ref.lab.scenes.grasps import aligned_grasp_step, grasp_step
from quasistatic_ref.optional.fast.compiled import why_not
from quasistatic_ref.optional.fast.guess.confirm import BallHessian, BallStep
from quasistatic_ref.step.data import Extra
from tests.certify.test_exact import resting_point
from tests.helpers import pinch, planted_step, random_step, sphere_on_floor
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


@pytest.mark.parametrize("step", STEPS.values(), ids=STEPS)
def test_the_right_working_set_is_confirmed_with_the_same_bits(step):
    truth, answer = optimum_and_answer(step)
    assert answer is not None
    assert differing(answer, truth) == []


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
