"""A guessed working set, confirmed in balls: the bits of the exact method, or None."""

import numpy as np
import pytest

from quasistatic_ref.certify.exact import exact_optimum, exact_step
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.errors import StepDataError
from quasistatic_ref.lab.scenes.contacts import no_contacts
from quasistatic_ref.lab.scenes.grasps import aligned_grasp_step, grasp_step
from quasistatic_ref.optional.fast.guess.confirm import BallHessian, BallStep
from quasistatic_ref.optional.fast.guess.exchange import Refuted
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.step.data import Extra, StepData
from quasistatic_ref.step.standard_form import standard_form
from tests.certify.test_exact import resting_point
from tests.helpers import changed, pinch, planted_step, random_step, sphere_on_floor
from tests.tolerances import ACTIVE_SET
from validation.make import confirmed_bits
from validation.make.confirmed_bits import CONES, checked, differing

FLOOR_OWN = Extra(("stop", "far"), [[1.0, 0, 0, 0, 0, 0, 0], [0, 1.0, 0, 0, 0, 0, 0]], [1e-4, -1.0])


def optimum_and_answer(step, guess=None):
    """What the exact method makes of a guess, its own working set by default, and what is new."""
    form = exact_form(step)
    truth = exact_optimum(form, () if guess is None else guess)
    given = truth.working_set if guess is None else guess
    return exact_optimum(form, given), BallStep(step, BallHessian(step)).confirmed(given)


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
    assert total["refused"] >= 50


def test_a_row_that_touches_and_bears_nothing_is_a_kink():
    step = resting_point(weight=0.0)
    truth, answer = optimum_and_answer(step)
    assert not truth.differentiable
    assert differing(answer, truth) == []
    assert differing(exact_step(step, truth.working_set), truth) == []


def test_the_violated_rows_are_named():
    """A body is pressed into one floor, the second of three contacts; the others are far."""
    step = resting_point(weight=2.0, contacts=3)
    step = step.replace(contacts=changed(step.contacts, phi=np.array([1.0, 0.0, 1.0])))
    found = BallStep(step, BallHessian(step)).confirmed([])
    form = standard_form(step)
    slack = form.A @ np.linalg.solve(form.H, form.g) - form.b
    assert isinstance(found, Refuted)
    assert np.flatnonzero(found.slack < 0).tolist() == np.flatnonzero(slack < 0).tolist()
    # With a row that touches and is not violated before it: 0 = slack < those of the others.
    own = step.replace(extra=Extra(("idle", "shut"), [[1.0, 0, 0, 0], [0, 0, 1.0, 0]], [0.0, 0.0]))
    far = own.replace(contacts=changed(step.contacts, phi=np.ones(3)))
    slack = BallStep(far, BallHessian(far)).confirmed([]).slack
    assert slack[18] == 0.0
    assert np.flatnonzero(slack < 0).tolist() == [19]


def test_a_refused_guess_has_its_point_in_float64_and_is_not_rounded(monkeypatch):
    """W without a row; the KKT system of what is left gives x and lam: H x - A_W'lam = g."""
    step = grasp_step(np.random.default_rng(5))
    form, rest = standard_form(step), optimum_and_answer(step)[0].working_set[1:]

    def refused(numbers):
        raise AssertionError("numbers of a guess that is wrong were rounded")

    monkeypatch.setattr("quasistatic_ref.optional.fast.guess.confirm.all_nearest", refused)
    found = BallStep(step, BallHessian(step)).confirmed(rest)
    assert isinstance(found, Refuted)
    assert found.working.tolist() == sorted(rest)
    A_W, n = form.A[found.working], step.n_v
    K = np.block([[form.H, -A_W.T], [A_W, np.zeros((len(A_W), len(A_W)))]])
    expected = np.linalg.solve(K, np.concatenate([form.g, form.b[found.working]]))
    slack = form.A @ expected[:n] - form.b
    for said, truth in ((found.slack, slack), (found.lam, expected[n:])):
        np.testing.assert_allclose(said, truth, rtol=0, atol=ACTIVE_SET * np.abs(truth).max())
    assert not found.slack[found.working].any()


def test_rows_that_depend_on_each_other_are_refused():
    """All six of a contact that sticks have rank four."""
    step = sphere_on_floor(wrench=(0.0, 0.0, -3.0, 0.0, 0.0, 0.0))
    assert BallStep(step, BallHessian(step)).confirmed(range(6)) is None


def test_a_mass_matrix_that_a_simulator_poses_is_checked():
    """1 and 1, and between them the float64 next to 1: the determinant is less than 0."""
    step = StepData(1.0, np.eye(0), np.eye(2), [], [0.0, 0.0], [], no_contacts(2))
    M_u = np.array([[1.0, np.nextafter(1.0, 2.0)], [np.nextafter(1.0, 2.0), 1.0]])
    object.__setattr__(step, "M_u", M_u)
    with pytest.raises(StepDataError, match="M_u: must be positive definite"):
        BallHessian(step)


def test_a_solver_keeps_the_inverse_of_H_while_H_is_the_same():
    step = random_step(np.random.default_rng(1))
    solver = solver_for(step, "clarabel", fast=True)
    solve_step(step, solver)
    first = solver.proofs.parts[0].kept.hessian
    assert first.fits(step)
    solve_step(step, solver)
    assert solver.proofs.parts[0].kept.hessian is first
    heavier = step.replace(M_u=2 * step.M_u)
    assert not first.fits(heavier)
    once = solve_step(heavier, solver)
    assert solver.proofs.parts[0].kept.hessian.fits(heavier)
    assert once == solve_step(heavier, "clarabel", fast=True)
