"""A guessed working set, confirmed in balls: the bits of the exact method, or None."""

import itertools

import numpy as np
import pytest
from flint import arb, ctx, fmpz_mat

from quasistatic_ref.certify.dependence import follow, spanned_in_contacts
from quasistatic_ref.certify.exact import ExactOptimum, exact_optimum
from quasistatic_ref.certify.exact_step import exact_step
from quasistatic_ref.certify.rational import exact_form, exact_rows
from quasistatic_ref.certify.rounding import all_nearest, nearest_in
from quasistatic_ref.errors import StepDataError
from quasistatic_ref.lab.scenes.contacts import no_contacts
from quasistatic_ref.lab.scenes.grasps import aligned_grasp_step, grasp_step
from quasistatic_ref.optional.fast.guess.confirm import BallHessian, BallStep
from quasistatic_ref.optional.fast.guess.exchange import Violated
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.step.data import Extra, StepData
from quasistatic_ref.step.standard_form import standard_form
from tests.certify.test_exact import resting_point
from tests.helpers import changed, pinch, planted_step, random_step, sphere_on_floor
from tests.tolerances import ACTIVE_SET, ROUNDING
from validation.make import confirmed_bits
from validation.make.confirmed_bits import CONES, checked, differing, random_case

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
    yield "no contact", random_step(rng).replace(contacts=no_contacts(7))


STEPS = dict(some_steps())


@pytest.mark.parametrize("step", STEPS.values(), ids=STEPS)
def test_the_right_working_set_is_confirmed_with_the_same_bits(step):
    truth, answer = optimum_and_answer(step)
    assert answer is not None
    assert differing(answer, truth) == []


@pytest.mark.parametrize("block", range(4))
def test_random_steps_have_the_same_bits_and_wrong_sets_are_refused(block):
    """A sample of validation/make/confirmed_bits.py."""
    outcomes = [checked(seed) for seed in range(block, 120, 4)]
    assert [faults for _, _, faults in outcomes if faults] == []
    total = {key: sum(found[key] for _, found, _ in outcomes) for key in confirmed_bits.COLUMNS}
    assert total["optima"] >= 24
    assert total["confirmed"] >= 0.95 * total["optima"]
    assert total["refused"] >= 50


def test_the_sample_has_every_cone_in_both_units():
    kinds = {random_case(seed)[0] for seed in range(2 * len(CONES))}
    assert kinds == {cone + scaled for cone in CONES for scaled in ("", ", badly scaled")}


@pytest.mark.parametrize(
    "step",
    [pinch(), sphere_on_floor(wrench=(0.5, 0.0, -3.0, 0.0, 0.0, 0.01))],
    ids=["pinch", "sphere"],
)
def test_zeros_that_the_rows_do_not_imply_are_confirmed_with_the_same_bits(step):
    """Here x is zero by symmetry, or because nothing pushes."""
    truth, answer = optimum_and_answer(step)
    assert answer is not None
    assert differing(answer, truth) == []
    assert (truth.delta_q == 0).any()


def test_a_row_that_touches_and_bears_nothing_is_left_to_the_exact_method():
    step = resting_point(weight=0.0)
    truth, answer = optimum_and_answer(step)
    assert answer is None
    assert not truth.differentiable
    assert differing(exact_step(step, truth.working_set), truth) == []


def test_a_row_guessed_to_press_that_bears_nothing_is_no_proof():
    """Without friction all six rows are one: that row spans the others, and says nothing of x."""
    step = resting_point(weight=0.0, mu_v=0.0, mu_omega=0.0)
    truth, _ = optimum_and_answer(step)
    assert not truth.differentiable
    assert BallStep(step, BallHessian(step)).confirmed([0]) is None


def test_the_first_violated_row_is_named():
    """A body is pressed into one floor, the second of three contacts; the others are far."""
    step = resting_point(weight=2.0, contacts=3)
    step = step.replace(contacts=changed(step.contacts, phi=np.array([1.0, 0.0, 1.0])))
    found = BallStep(step, BallHessian(step)).confirmed([])
    form = standard_form(step)
    slack = form.A @ np.linalg.solve(form.H, form.g) - form.b
    assert isinstance(found, Violated)
    assert found.row == np.flatnonzero(slack < 0)[0] == 6
    # With a row that touches and is not violated before it: 0 = slack < those of the others.
    own = step.replace(extra=Extra(("idle", "shut"), [[1.0, 0, 0, 0], [0, 0, 1.0, 0]], [0.0, 0.0]))
    far = own.replace(contacts=changed(step.contacts, phi=np.ones(3)))
    assert BallStep(far, BallHessian(far)).confirmed([]).row == 19


def test_a_refused_guess_has_its_point_in_float64_and_is_not_rounded(monkeypatch):
    """W without a row; the KKT system of what is left gives x and lam: H x - A_W'lam = g."""
    step = grasp_step(np.random.default_rng(5))
    form, rest = standard_form(step), optimum_and_answer(step)[0].working_set[1:]

    def refused(numbers):
        raise AssertionError("numbers of a guess that is wrong were rounded")

    monkeypatch.setattr("quasistatic_ref.optional.fast.guess.confirm.all_nearest", refused)
    found = BallStep(step, BallHessian(step)).confirmed(rest)
    assert isinstance(found, Violated)
    assert set(found.working) <= set(rest)
    A_W, n = form.A[found.working], step.n_v
    K = np.block([[form.H, -A_W.T], [A_W, np.zeros((len(A_W), len(A_W)))]])
    expected = np.linalg.solve(K, np.concatenate([form.g, form.b[found.working]]))
    for said, truth in ((found.delta_q, expected[:n]), (found.lam, expected[n:])):
        np.testing.assert_allclose(said, truth, rtol=0, atol=ACTIVE_SET * np.abs(truth).max())
    assert form.A[found.row] @ found.delta_q < form.b[found.row]


def test_the_net_impulse_is_what_the_balance_says():
    """H delta_q - g of Eq. (9), in float64."""
    step = random_step(np.random.default_rng(4))
    form, delta_q = standard_form(step), np.random.default_rng(5).standard_normal(7)
    with ctx.workprec(200):
        found = [float(v) for v in BallHessian(step).net(step, [arb(v) for v in delta_q.tolist()])]
    expected = form.H @ delta_q - form.g
    np.testing.assert_allclose(found, expected, rtol=0, atol=ROUNDING * np.abs(expected).max())


def test_without_any_of_its_rows_a_unique_working_set_is_refused():
    tried = 0
    for seed in range(5, 40, 5):
        step = grasp_step(np.random.default_rng(seed))
        truth, _ = optimum_and_answer(step)
        if not truth.multipliers_unique:
            continue
        hessian, working = BallHessian(step), truth.working_set
        for rest in itertools.combinations(working, len(working) - 1):
            tried += 1
            assert isinstance(BallStep(step, hessian).confirmed(rest), Violated)
    step = planted_step(np.random.default_rng(0), rows=(4, 4))[0]
    truth, _ = optimum_and_answer(step)
    assert isinstance(BallStep(step, BallHessian(step)).confirmed([]), Violated)
    assert truth.working_set
    tried += 1
    assert tried >= 1


def test_rows_that_depend_on_each_other_are_refused():
    """All six of a contact that sticks have rank four."""
    step = sphere_on_floor(wrench=(0.0, 0.0, -3.0, 0.0, 0.0, 0.0))
    assert BallStep(step, BallHessian(step)).confirmed(range(6)) is None


@pytest.mark.parametrize("field", ["delta_q", "lam", "net", "slack"])
def test_another_bit_is_noticed_by_the_script(monkeypatch, field):
    class Spoilt(BallStep):
        def confirmed(self, guess):
            answer = super().confirmed(guess)
            if isinstance(answer, ExactOptimum):
                numbers = getattr(answer, field)
                numbers[:] = np.nextafter(numbers, np.inf)
            return answer

    monkeypatch.setattr(confirmed_bits, "BallStep", Spoilt)
    kind, _, faults = checked(0)
    assert len(faults) >= 1
    assert all(fault.startswith(f"{kind}, step 0") and field in fault for fault in faults)


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
    first = solver.hessian
    assert first.fits(step)
    solve_step(step, solver)
    assert solver.hessian is first
    heavier = step.replace(M_u=2 * step.M_u)
    assert not first.fits(heavier)
    once = solve_step(heavier, solver)
    assert solver.hessian.fits(heavier)
    assert once == solve_step(heavier, "clarabel", fast=True)


def test_exact_rows_are_those_of_the_exact_form():
    step = random_step(np.random.default_rng(2)).replace(extra=FLOOR_OWN)
    form = exact_form(step)
    rows = [form.m - 1, 3, 0, form.m - 2, 7]
    for found, i in zip(exact_rows(step, rows), rows, strict=True):
        both = fmpz_mat([[int(v) for v in found[:-1]], [int(v) for v in form.row(i)]])
        assert both.rank() == 1  # equal but for a factor
        signs = [(a > 0) - (a < 0) for a in found]
        assert signs == [(a > 0) - (a < 0) for a in [*form.row(i), form.b[i, 0]]]


def test_rows_that_are_seen_to_be_spanned_are_spanned():
    """Of a contact, +d1 and -d1 add up to +d2 and -d2, and to +spin and -spin."""
    step = sphere_on_floor(wrench=(0.0, 0.0, -3.0, 0.0, 0.0, 0.0))
    seen = {
        (working, row): spanned_in_contacts(step, working, [row])
        for working in itertools.combinations(range(6), 3)
        for row in set(range(6)) - set(working)
    }
    for (working, row), is_seen in seen.items():
        held, (equation,) = exact_rows(step, working), exact_rows(step, [row])
        assert follow(held, [equation]) == [is_seen]
    assert seen[(0, 1, 2), 3]
    assert seen[(0, 2, 4), 5]
    assert not seen[(0, 1, 4), 5]


def test_contacts_with_one_spin_share_its_generator():
    step = pinch()
    c = step.contacts
    np.testing.assert_array_equal(c.J[0, 3], -c.J[1, 3])  # opposite normals
    # Rows 0-5 and 6-11: gap + spin and gap - spin of each; the second contact's spin is minus.
    assert spanned_in_contacts(step, [4, 5, 10], [11])
    assert not spanned_in_contacts(step, [4, 10], [11])


def test_many_balls_are_rounded_as_each_is():
    rng = np.random.default_rng(0)
    with ctx.workprec(200):
        values = rng.standard_normal(100) * 10.0 ** rng.integers(-200, 200, 100)
        balls = [arb(v) / 3 for v in values.tolist()]
        balls += [arb(2) ** k * (1 + s * arb(2) ** -54 * f)
                  for k in (-1074, -1060, -1022, -900, 0, 1000) for s in (-1, 1)
                  for f in (arb(1) / 3, arb(1), arb(2), arb(3))]  # fmt: skip
        third = arb(1) / 3
        balls += [arb(0), third - third, arb(5e-324), arb(1e308) * 10, arb("nan"), -arb(0)]
        found, shown = all_nearest(balls)
    for ball, x, is_shown in zip(balls, found.tolist(), shown.tolist(), strict=True):
        with ctx.workprec(200):
            expected = nearest_in(ball)
        assert is_shown == (expected is not None)
        if is_shown:
            assert x == expected
            assert str(x) != "-0.0"
