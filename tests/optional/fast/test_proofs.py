"""Connected bodies, proved in the groups that press on each other."""

from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quasistatic_ref import Extra, StepIllPosed, StepInfeasible, StepNotSolved, solve_step
from quasistatic_ref.certify.exact import form_optimum, step_optimum
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.lab.scenes.piles import SIDE, pile
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.optional.fast import proofs
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.optional.large.blocks import Blocks
from quasistatic_ref.optional.large.sparse_contacts import SparseContacts
from quasistatic_ref.solve.backends import NONE
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.tolerances import ACCURACY
from tests.helpers import changed
from tests.oracles.grouped import unlike_fields
from tests.oracles.random_steps import designed_step, equal_groups, mixed_step
from validation.make import designed_steps


def optimum_of(step):
    """The optimum by the proofs of `fast`, and the greatest number of groups that they made."""
    solver = solver_for(step, "daqp", fast=True)
    both = solver.in_both_units(step)
    answer = None
    with suppress(StepNotSolved):  # of the backend: the exact method starts from cold
        answer = solver.answer(both, ACCURACY)
    return solver.prover.optimum(both, answer), len(solver.prover.proofs.parts)


@pytest.mark.extra("fast")
@pytest.mark.parametrize("touching", [proofs.TOUCHING, -np.inf])
def test_contacts_that_do_not_touch_are_left_out_and_proved_open(monkeypatch, touching):
    """With -inf all rows that bear nothing are left out, also those that the answer needs."""
    monkeypatch.setattr(proofs, "SMALL", 0)
    monkeypatch.setattr(proofs, "TOUCHING", touching)
    several = 0
    for seed in range(20):
        step = mixed_step(seed)
        try:
            optimum, parts = optimum_of(step)
        except (StepInfeasible, StepIllPosed):
            continue
        assert unlike_fields(optimum, form_optimum(exact_form(step))) == [], seed
        several += parts > 1
    assert several > 1


@pytest.mark.extra("fast")
def test_a_row_of_boxes_that_is_pushed_has_the_bits_of_the_whole(monkeypatch):
    some = pile((5, 1, 1), gap=0.004, yaw=0.1, certify="full", backend="daqp")
    q = some.q
    for _ in range(2):
        result = some.simulator.step(q, np.zeros(0), some.force)
        q = result.q
    assert len(some.simulator.solver.prover.proofs.parts) >= 5
    whole = form_optimum(exact_form(result.step), np.flatnonzero(result.solution.lam).tolist())
    assert result.solution.delta_q.tobytes() == whole.delta_q.tobytes()
    assert unlike_fields(optimum_of(result.step)[0], whole) == []


@pytest.mark.extra("fast")
def test_groups_are_kept_while_h_and_what_couples_them_stay():
    some = pile((2, 1, 1), gap=SIDE, certify="off", backend="daqp")
    step = some.simulator.step(some.q, np.zeros(0), some.force).step.replace()
    solver = solver_for(step, "daqp", fast=True)
    others = step.replace(h=2 * step.h), step.replace(M_u=2 * step.M_u), step
    for other in (step, *others):
        assert solve_step(other, solver) == solve_step(other, "daqp", fast=True)
        before = solver.prover.proofs.parts
        solve_step(other, solver)
        assert solver.prover.proofs.parts is before


def step_with_own_rows(counts, rng):
    """Equal free coordinates of which coordinate i has counts[i] rows of a user's own."""
    n = len(counts)
    A = np.repeat(np.eye(n), counts, axis=0)
    own = Extra(tuple(f"own {i}" for i in range(len(A))), A, rng.choice([-0.5, 0.25, 1.0], len(A)))
    nothing = contacts_of(np.zeros(0), np.zeros((0, 3, 3)), np.zeros((0, 4, n)), 0.5)
    return free_step(np.eye(n), np.ones(n), nothing, 0.01).replace(extra=own)


@pytest.mark.extra("fast")
@pytest.mark.parametrize("counts", [(1, 2), (2, 1), (0, 1), (1, 1, 2), (0, 2, 1), (1, 0, 1, 2)])
def test_equal_groups_have_any_numbers_of_own_rows(counts):
    """A smaller number than that of the group before must not broadcast either."""
    step = step_with_own_rows(counts, np.random.default_rng(1))
    solver = solver_for(step, "daqp", fast=True)
    assert bits(solve_step(step, solver).delta_q) == bits(solve_step(step, NONE).delta_q)
    kept = {}
    for part in solver.prover.proofs.parts:
        kept.setdefault(id(part.kept), set()).add(len(part.group.extra_rows))
    assert all(len(numbers) == 1 for numbers in kept.values())


@settings(max_examples=60)
@given(seed=st.integers(0, 2**32 - 1))
def test_equal_groups_that_differ_in_all_else_have_the_exact_optimum(seed):
    """One solver solves three steps of one kind after the other, as in a run."""
    rng = np.random.default_rng(seed)
    step = equal_groups(rng)
    solver = solver_for(step, "daqp", fast=True)
    for factor in (1.0, 0.5, -1.0):
        step = step.replace(tau_u=factor * step.tau_u)
        plain = outcome(step, NONE)
        assert outcome(step, solver) == plain


def outcome(step, solver):
    """Of a step that is solved, what its optimum determines; of another one, why it is refused."""
    try:
        found = solve_step(step, solver)
    except (StepInfeasible, StepIllPosed) as refused:
        return type(refused)
    optimum = found.certificate
    return bits((found.delta_q, found.net_impulse)), optimum.multipliers_unique


def test_both_speeds_have_the_optimum_in_fractions():
    """A sample: ``validation/make/designed_steps.py`` compares 20,000."""
    words = [designed_steps.outcome(designed_step(seed)) for seed in range(100000, 100040)]
    assert set(words) == {"same optimum", "no solution"}


def test_steps_after_those_of_no_page_are_refused(tmp_path):
    with pytest.raises(SystemExit, match="holds no counts of the steps before 40"):
        designed_steps.counts_before(tmp_path / "none.md", 40)


def test_what_is_kept_for_a_step_refuses_numbers_of_another_shape():
    kept = Structure("groups.c", "Step")
    kept.put({"b": np.zeros(2)})
    with pytest.raises(ValueError, match=r"^b has shape \(1,\) in place of \(2,\)$"):
        kept.write("b", np.ones(1))


def test_one_solver_is_given_contacts_in_blocks_of_other_bodies():
    """The second contact pushes the third body, with the same entries of J in other columns."""
    body = np.eye(3)
    J = np.zeros((1, 4, 6))
    J[0, :3] = np.hstack([-body, body])
    steps = []
    for other in (3, 6):
        columns = np.array([[0, 1, 2, other, other + 1, other + 2]])
        like = contacts_of(-1e-3, body[None], np.zeros((1, 4, 9)), 0.5)
        own = like.name, like.phi, like.n, like.d1, like.d2, Blocks(columns, J, 9)
        contacts = SparseContacts(*own, like.mu_v, like.mu_omega, like.rows)
        steps.append(free_step(np.eye(9), np.ones(9), contacts, 0.01))
    solver = solver_for(steps[0].replace(contacts=changed(steps[0].contacts)), "daqp", fast=True)
    for step in steps:
        answer = solve_step(step, solver)
        assert answer.delta_q.tobytes() == step_optimum(step).delta_q.tobytes()
