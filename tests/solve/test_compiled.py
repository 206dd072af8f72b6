"""The data of a solve by the compiled map: those of CVXPY, in every bit."""

import sys

import cvxpy as cp
import numpy as np
import pytest
import scipy.sparse as sp

from quasistatic_ref import Extra, solve_step
from quasistatic_ref.solve import compiled as of_compiled
from quasistatic_ref.solve.compiled import CompiledMap
from quasistatic_ref.solve.problem_data import problem_data
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.step_problem import StepProblem
from quasistatic_ref.solve.through_cvxpy import CvxpySolver
from quasistatic_ref.solve.units import StepInBothUnits
from tests.cases import cases
from tests.helpers import PAPER, planted_step, random_step

SIZES = [PAPER, (3, 0, (4, 4)), (0, 4, (6, 4)), (2, 3, ())]


def bits(value):
    if sp.issparse(value):
        parts = (value.data, value.indices, value.indptr)
        return type(value), value.shape, *map(bits, parts)
    if isinstance(value, np.ndarray):
        return value.dtype, value.shape, value.tobytes()
    return value


def with_zeros(rng, parameter):
    """Some entries of a parameter become zero: CVXPY may not drop them from its matrices."""
    if not parameter.attributes["PSD"]:
        parameter.save_value(parameter.value * rng.integers(0, 2, parameter.shape))


@pytest.mark.parametrize("cone", ["pyramid", "product", "facets-8", "frictionless", "ellipsoid"])
@pytest.mark.parametrize(("n_a", "n_u", "rows"), SIZES)
def test_every_number_of_the_data_has_the_bits_of_cvxpy_s(cone, n_a, n_u, rows, rng):
    own = Extra(("a", "b"), rng.normal(size=(2, n_a + n_u)), rng.normal(size=2))
    step = random_step(rng, n_a, n_u, rows).replace(cone=cone, extra=own)
    problem = StepProblem(step)
    template = problem_data(problem.problem, "clarabel", {})
    assert CompiledMap.serves(template)
    compiled = CompiledMap(problem.problem, template)
    for _ in range(3):
        other = random_step(rng, n_a, n_u, rows)
        for name in ("K_q", "M_u", "tau_a", "tau_u"):
            problem.parameters[name].save_value(getattr(other, name))
        for name in ("phi", "J_n", "J_1", "J_2", "J_w", "A_extra", "b_extra"):
            parameter = problem.parameters[name]
            parameter.save_value(rng.normal(size=parameter.shape))
            with_zeros(rng, parameter)
        found = compiled.data({"max_iter": 7})
        numbers = {name: bits(value) for name, value in found.numbers.items()}
        expected = problem_data(problem.problem, "clarabel", {"max_iter": 7})
        assert numbers == {name: bits(value) for name, value in expected.numbers.items()}
        offsets = (np.asarray(data.inverse[-1]["offset"]) for data in (found, expected))
        assert len({offset.tobytes() for offset in offsets}) == 1
        assert found.inverse[-1].solver_options == expected.inverse[-1].solver_options


@pytest.mark.parametrize("moved", [None, "cvxpy.cvxcore.python.canonInterface"])
def test_answers_have_the_bits_of_the_problem_s_own_solve(moved, rng, monkeypatch):
    """Also where CVXPY has moved a name that is private to it."""
    step = planted_step(rng)[0]
    if moved is not None:
        monkeypatch.setitem(sys.modules, moved, None)
        monkeypatch.delitem(sys.modules, CompiledMap.__module__)
    solver = CvxpySolver(step, "clarabel")
    both = StepInBothUnits(step)
    solver.write(both)
    assert (solver._compiled == (None, None)) == (moved is not None)
    _, options = solver.option_sets(1e-12)[0]
    reply = solver.reply(options, both)
    problem = solver.problem
    problem.problem.solve(cp.CLARABEL, warm_start=False, **options)
    assert reply.solved
    assert reply.x.tobytes() == problem.primal().tobytes()
    assert reply.lam.tobytes() == problem.dual().tobytes()


def test_a_cost_that_a_backend_does_not_take_is_said_in_our_words():
    """CVXPY's warning of parameters, which ECOS causes, is one of p^2 x, too."""
    p, x = cp.Parameter(value=2.0), cp.Variable()
    problem = cp.Problem(cp.Minimize(p * p * x), [x >= 1])
    with pytest.warns(UserWarning, match="^clarabel takes no quadratic cost") as said:
        problem_data(problem, "clarabel", {})
    assert len(said) == 1


@pytest.mark.parametrize("cone", ["pyramid", "product", "facets-8"])
def test_clarabel_is_called_as_by_cvxpy(cone, rng, monkeypatch):
    """From the second step on without CVXPY's own call, to the same bits."""
    steps = [planted_step(rng)[0].replace(cone=cone) for _ in range(4)]
    steps = [step.replace(contacts=steps[0].contacts) for step in steps]
    solver = CvxpySolver(steps[0])
    solve_step(steps[0], solver)
    plain = [solve_step(step, CvxpySolver(step), certify="off") for step in steps]
    monkeypatch.setattr("quasistatic_ref.solve.through_cvxpy.cvxpy_reply", None)
    for step, expected in zip(steps, plain, strict=True):
        found = solve_step(step, solver, certify="off")
        assert bits(found.delta_q) == bits(expected.delta_q)
        assert bits(found.lam) == bits(expected.lam)
        assert found.statistics.iterations == expected.statistics.iterations


WRONG = Reply(np.zeros(7), np.zeros(16), True, "optimal")
CALLS = {
    "cones that CVXPY has moved": lambda patch: patch.delattr(of_compiled, "dims_to_solver_cones"),
    "a name that CVXPY has moved": lambda patch: patch.delattr(of_compiled, "CLARABEL"),
    "another answer": lambda patch: patch.setattr(
        of_compiled.ClarabelCall, "reply", lambda *_: WRONG
    ),
}


@cases("spoil", CALLS)
def test_a_call_that_fails_or_answers_otherwise_costs_no_answer(spoil, rng, monkeypatch):
    step = planted_step(rng)[0]
    expected = solve_step(step, CvxpySolver(step), certify="off")
    spoil(monkeypatch)
    found = [solve_step(step, solver, certify="off") for solver in 2 * [CvxpySolver(step)]]
    assert {bits(one.delta_q) for one in found} == {bits(expected.delta_q)}
