"""Steps of many bodies: blocks, sparse form and sparse backends against the dense ones."""

from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import BackendError, StepDataError, solve_step, standard_form
from quasistatic_ref.lab.scenes.piles import pile
from quasistatic_ref.optional.fast.sparse_solver import MOST_ITERATIONS, SparseSolver, reachable
from quasistatic_ref.optional.large.blocks import Blocks
from quasistatic_ref.optional.large.sparse_contacts import SparseContacts
from quasistatic_ref.optional.large.sparse_form import Pattern, sparse_form
from quasistatic_ref.solve.backends import BACKENDS
from quasistatic_ref.solve.units import FAR
from tests.closeness import assert_relative, assert_within
from tests.helpers import always_in_blocks, changed, in_blocks, random_step
from tests.tolerances import OPTIMUM, ROUNDING

BOXES = (2, 1, 2)
NO_TARGET = np.zeros(0)


@pytest.fixture
def always_sparse(monkeypatch):
    always_in_blocks(monkeypatch)


def step_after(some, count):
    """The last of a few steps of a pile, and its solution."""
    q = some.q
    for _ in range(count):
        result = some.simulator.step(q, NO_TARGET, some.force)
        q = result.q
    return result


def test_blocks_that_keep_a_coordinate_in_another_place_are_told_apart():
    """What a proof keeps of a step reads J by its places."""
    c = random_step(np.random.default_rng(1), rows=(6,)).contacts
    own = {name: getattr(c, name) for name in c.kept() if name != "J"}
    J = np.ones((1, 4, 1))
    none = np.zeros((1, 4, 1))
    later = SparseContacts(**own, blocks=Blocks([[0, 1]], np.concatenate([none, J], axis=2), 3))
    first = SparseContacts(**own, blocks=Blocks([[1, 2]], np.concatenate([J, none], axis=2), 3))
    assert later.J.tobytes() == first.J.tobytes()
    assert later.moving() != first.moving()


@pytest.mark.extra("fast")
def test_the_sparse_form_is_the_standard_form(always_sparse):
    step = step_after(pile(BOXES), 2).step
    form = sparse_form(step, Pattern(step))
    dense = standard_form(step)
    np.testing.assert_array_equal(form.H.toarray(), dense.H)
    np.testing.assert_array_equal(form.g, dense.g)
    assert_within(form.A.toarray(), dense.A, ROUNDING)
    np.testing.assert_array_equal(form.b, dense.b)
    # Of 24 columns each row has those of its two bodies: 6 to the floor, 12 between boxes.
    assert form.A.nnz == sum(
        int(rows) * (6 if name.startswith("floor") else 12)
        for name, rows in zip(step.contacts.name, step.counts, strict=True)
    )


@pytest.mark.parametrize("backend", [b.name for b in BACKENDS.values() if b.sparse])
def test_a_sparse_answer_is_the_certified_one_to_its_accuracy(always_sparse, backend):
    result = step_after(pile(BOXES, backend=backend, certify="residual"), 3)
    assert result.solution.certificate.kind == "residual"
    exact = solve_step(result.step, certify="full")
    wrong = np.linalg.norm(result.solution.delta_q - exact.delta_q)
    assert 0 < wrong <= OPTIMUM * np.linalg.norm(exact.delta_q)
    A = standard_form(result.step).A
    assert_within(
        A.T @ result.solution.lam, A.T @ exact.lam, OPTIMUM * np.abs(A.T @ exact.lam).max()
    )


@pytest.mark.extra("fast")
def test_size_decides_whether_a_step_is_sparse(monkeypatch):
    # 2 x 1 x 2 boxes: 2 pairs with the floor, 2 side by side, 2 above each other, 4 contacts each
    entries = 4 * 24 * 24
    for limit, certify, sparse in (
        (entries, "off", True),
        (entries + 1, "off", False),
        (entries, "residual", True),
        (entries, "full", True),
    ):
        entry = replace(BACKENDS["clarabel"], sparse=limit)
        monkeypatch.setitem(BACKENDS, "clarabel", entry)
        some = pile(BOXES, certify=certify)
        assert some.contacts == 24
        step = step_after(some, 1).step
        assert isinstance(step.contacts, SparseContacts) == sparse


def test_a_backend_without_a_sparse_interface_is_refused_for_a_large_step(always_sparse):
    step = step_after(pile(BOXES), 1).step
    with pytest.raises(
        BackendError, match=r"takes no sparse matrices; .* clarabel, osqp, piqp, daqp"
    ):
        SparseSolver(step, "quadprog")


def test_rows_out_of_reach_are_moved_to_their_reach():
    """Then b is -FAR max(1, |a_i|); of these rows some are longer than one."""
    step = random_step(np.random.default_rng(3))
    step = step.replace(contacts=changed(step.contacts, phi=[1e-4, 50.0, 2e-4]))
    step = in_blocks(step)
    solver = SparseSolver(step, "clarabel")
    both = solver.in_both_units(step)
    _, _, A, b = both.natural_form
    out_of_reach = solver.write(both)
    reach = -FAR * np.maximum(1.0, np.linalg.norm(A.toarray(), axis=1))
    assert reach.min() < -FAR
    np.testing.assert_array_equal(out_of_reach, b < reach)
    assert 0 < out_of_reach.sum() < len(b)
    assert_relative(solver.program.b, np.maximum(b, reach), ROUNDING)


def test_loads_whose_squares_vanish_move_the_size_and_nothing_else(rng):
    # Loads and gaps of 2^-900 of a step's are those of the same step in units of 2^-900.
    power = 2.0**-900
    step = random_step(rng)
    names = ("tau_a", "tau_u", "delta_q_bar_a")
    tiny = step.replace(
        **{name: power * getattr(step, name) for name in names},
        contacts=changed(step.contacts, phi=power * step.contacts.phi),
    )
    solver = SparseSolver(in_blocks(step), "clarabel")
    units = solver.in_both_units(in_blocks(step)).units
    of_tiny = solver.in_both_units(in_blocks(tiny)).units
    assert (of_tiny.size, of_tiny.length) == (power * units.size, units.length)


def test_contacts_in_blocks_are_raised_as_others_are():
    step = random_step(np.random.default_rng(3))
    contacts = in_blocks(step).contacts
    s = np.array([1e-3, 2e-3, 0.0])
    raised = contacts.raised(s)
    np.testing.assert_array_equal(raised.phi, step.contacts.phi + s)
    assert raised.blocks is contacts.blocks


@pytest.mark.parametrize("column", [[1, 0], [1, 1], [-1, 0], [2, 4], [3, 2]])
def test_columns_that_do_not_ascend_are_refused(column):
    with pytest.raises(StepDataError, match=r"blocks.column: must ascend .* n_v = 3"):
        Blocks(np.array([[0, 3], column]), np.zeros((2, 4, 2)), 3)


def test_a_gap_is_not_asked_to_be_less_than_rounding_leaves_of_it():
    tight = BACKENDS["clarabel"].option_sets(1e-12)[0]
    assert tight["tol_gap_abs"] == 1e-14
    large = reachable(tight, 1000)
    assert large["tol_gap_abs"] == large["tol_gap_rel"] == 1000 * 2.0**-52
    changed = {"tol_gap_abs", "tol_gap_rel", "max_iter"}
    assert {name for name in tight if tight[name] != large[name]} == changed
    assert reachable(tight, 10) == tight | {"max_iter": MOST_ITERATIONS}
    split = BACKENDS["osqp"].option_sets(1e-12)[0]
    assert reachable(split, 1000) == split  # it has no gap, and needs its many iterations
