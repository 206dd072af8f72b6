"""Backends by their own interface: the program is CVXPY's, certified answers have its bits."""

import subprocess
import sys

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.errors import BackendError, InputError
from quasistatic_ref.optional.extensions.extended import extension_rows, with_rows
from quasistatic_ref.optional.fast.native import NativeSolver
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.backends import installed
from quasistatic_ref.solve.cvxpy_problem import CvxpyProblem
from quasistatic_ref.solve.scaled import DenseStep
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.solve.units import natural_units, to_natural, within_reach
from quasistatic_ref.step.extension import Extension
from quasistatic_ref.step.standard_form import standard_form
from tests.helpers import SHAPES, changed, error, pinch, planted_step, random_step
from tests.tolerances import ACTIVE_SET, EXACT, FOUR_ULP, OPTIMUM

every_backend = pytest.mark.parametrize("backend", installed("native"))


def some_limits(symbols):
    """Two inequalities, of vectors and of a number, and an equation."""
    return [
        symbols.delta_q_a <= 1e-2,
        cp.sum(symbols.delta_q_u) >= -0.5,
        symbols.delta_q_a[0] == 2e-4,
    ]


def by_cvxpy(step, limits):
    """H, g, and (A, b) of the inequalities, then of the equations, as CVXPY compiles them."""
    problem = CvxpyProblem(step, constraints=limits)
    problem.fill(step)
    data, _, _ = problem.problem.get_problem_data(cp.OSQP, solver_opts={})
    P = data["P"].toarray()
    rows = -data["F"].toarray(), -data["G"], data["A"].toarray(), data["b"]
    return np.triu(P) + np.triu(P, 1).T, -data["q"], *rows


@pytest.mark.parametrize("shape", SHAPES[:2], ids=str)
def test_the_standard_form_is_what_cvxpy_compiles_to_four_ulp(shape, rng):
    # CVXPY's rows go through i first, ours through the contacts; an equation is two rows of ours.
    step = random_step(rng, *shape)
    form = standard_form(with_rows(step, extension_rows(step, Extension(some_limits))))
    H, g, A, b, E, e = by_cvxpy(step, some_limits)
    order = [step.offsets[j] + i for i in range(6) for j in np.flatnonzero(step.counts > i)]
    m, own = len(order), step.n_a + 1
    ours = [*order, *range(m, m + own)]
    for found, expected in (
        (form.H, H), (form.A[ours], A), (form.b[ours], b),
        (form.A[m + own], -E[0]), (form.b[m + own], -e[0]),
        (form.A[m + own + 1], E[0]), (form.b[m + own + 1], e[0]),
    ):  # fmt: skip
        np.testing.assert_allclose(found, expected, rtol=FOUR_ULP, atol=0.0)
    # g is a sum that may cancel, on either side in its own order: against its terms.
    terms = np.concatenate([np.abs(step.K_q) @ np.abs(step.delta_q_bar_a), np.zeros(step.n_u)])
    terms += np.abs(np.concatenate([step.tau_a, step.tau_u]))
    assert (np.abs(form.g - g) <= FOUR_ULP * step.h * terms).all()


@every_backend
@pytest.mark.parametrize("far", [False, True])
def test_the_program_handed_over_is_the_standard_form_of_the_natural_step(backend, far, rng):
    # Written again, it holds nothing of the step before.
    solver = NativeSolver(random_step(rng), backend)
    solver.answer(DenseStep(random_step(rng)), 1e-9)
    step = random_step(rng)
    if far:
        step = step.replace(contacts=changed(step.contacts, phi=[1e-4, 50.0, 2e-4]))
    solver.answer(DenseStep(step), 1e-9)
    natural = to_natural(step, natural_units(step))
    expected = standard_form(within_reach(natural) if solver.adapter.NEAR else natural)
    program = solver.program
    for found, value in ((program.H, expected.H), (program.f, -expected.g),
                         (program.A, expected.A), (program.b, expected.b)):  # fmt: skip
        np.testing.assert_allclose(found, value, rtol=EXACT, atol=EXACT)


@every_backend
@pytest.mark.parametrize("shape", SHAPES, ids=str)
def test_each_backend_follows_steps_that_change_in_everything(backend, shape):
    solver = None
    for seed in range(2):
        rng = np.random.default_rng(seed)
        for step in (random_step(rng, *shape), planted_step(rng, *shape)[0]):
            solver = NativeSolver(step, backend) if solver is None else solver
            truth = solve_step(step, "none").delta_q
            answer = solve_step(step, solver, certify="off")
            assert error(step, answer.delta_q, truth) <= OPTIMUM


@every_backend
def test_certified_steps_have_the_bits_of_the_exact_method(backend, rng):
    for step in (random_step(rng), pinch(), pinch(grip=0.5)):
        one = solve_step(step, "none")
        two = solve_step(step, NativeSolver(step, backend))
        A = standard_form(step).A
        np.testing.assert_allclose(two.delta_q, one.delta_q, rtol=EXACT, atol=EXACT)
        assert two.certificate.kind == "exact"
        np.testing.assert_allclose(A.T @ two.lam, A.T @ one.lam, rtol=1e-12, atol=1e-15)


def test_starting_warm_changes_no_answer_and_costs_fewer_iterations():
    scenario = load_scenario("bunny_grasp", ["steps=75", "solver.backend=daqp"], fast=True)
    run = scenario.run(progress=False)
    steps = [run.step_data(k) for k in range(55, 75)]
    warm = NativeSolver(steps[0], "daqp")
    cold = NativeSolver(steps[0], "daqp", warm=False)
    iterations = np.zeros(2, dtype=int)
    for step in steps:
        one, two = (solve_step(step, solver, certify="off") for solver in (warm, cold))
        assert error(step, one.delta_q, two.delta_q) <= ACTIVE_SET
        iterations += [one.statistics.iterations, two.statistics.iterations]
    assert iterations[0] < iterations[1] / 2


REFUSED = {
    "through CVXPY alone": "highs",
    "another interface": "qpsolvers:daqp",
    "unknown": "dapq",
}


@pytest.mark.parametrize("name", REFUSED.values(), ids=REFUSED)
def test_a_backend_without_an_interface_of_its_own_is_refused(name, rng):
    with pytest.raises(BackendError, match=r"has no interface of its own .* clarabel, .* have"):
        NativeSolver(random_step(rng), name)


@pytest.mark.parametrize("own", [0, 3])
def test_the_ellipsoid_s_program_is_what_cvxpy_compiles(own, rng):
    # In natural units, a contact out of reach included. CVXPY has the user's rows first.
    step = random_step(rng, 3, 4, (6, 4)).replace(cone="ellipsoid")
    step = step.replace(contacts=changed(step.contacts, phi=[1e-4, 50.0]))
    if own:
        step = with_rows(step, extension_rows(step, Extension(lambda s: [s.delta_q_a <= 1e-2])))
    solver = solver_for(step, "clarabel", fast=True)
    solver.write(DenseStep(step))
    natural = within_reach(to_natural(step, natural_units(step)))
    problem = CvxpyProblem(natural)
    problem.fill(natural)
    data, _, _ = problem.problem.get_problem_data(cp.CLARABEL, solver_opts={})
    dims = data["dims"]
    assert (dims.zero, dims.nonneg, dims.soc) == (0, own, [4] * solver.program.cones)
    P, program = data["P"].toarray(), solver.program
    A, b = (np.roll(rows, -own, axis=0) for rows in (-data["A"].toarray(), -data["b"]))
    for found, expected in (
        (program.H, np.triu(P) + np.triu(P, 1).T), (program.f, data["c"]),
        (program.A, A), (program.b, b),
    ):  # fmt: skip
        np.testing.assert_allclose(found, expected, rtol=FOUR_ULP, atol=EXACT)


def test_the_ellipsoid_s_native_answers_are_those_through_cvxpy(rng):
    for step in (random_step(rng), planted_step(rng)[0], pinch(grip=5.0, offset=0.2)):
        conic = step.replace(cone="ellipsoid")
        native, compiled = solver_for(conic, "clarabel", fast=True), solver_for(conic, "clarabel")
        one, two = (solve_step(conic, s, certify="residual") for s in (native, compiled))
        assert error(conic, one.delta_q, two.delta_q) <= OPTIMUM
        enclosed = [solve_step(conic, s) for s in (native, compiled, "none")]
        assert {answer.certificate.kind for answer in enclosed} <= {"enclosure", "exact"}
        for answer in enclosed[1:]:
            np.testing.assert_array_equal(answer.delta_q, enclosed[0].delta_q)


def test_the_ellipsoid_is_refused_natively_by_backends_of_rows(rng):
    with pytest.raises(BackendError, match="takes only linear rows; the ellipsoid needs one of"):
        solver_for(random_step(rng).replace(cone="ellipsoid"), "daqp", fast=True)


def test_extensions_that_are_more_than_rows_need_cvxpy(rng):
    step = random_step(rng)
    curved = Extension(lambda s: [cp.norm(s.delta_q) <= 1.0])
    with pytest.raises(
        BackendError,
        match="takes linear constraints only; for a cost or a nonlinear constraint pass",
    ):
        solve_step(step, NativeSolver(step, "clarabel"), extension=curved)


def test_an_engine_is_refused_in_a_sentence_that_names_fast(capsys):
    with pytest.raises(
        InputError, match=r"solver\.engine: is not a field any more; use fast = true"
    ):
        load_scenario("sphere_spin", ["solver.engine=native"])
    with pytest.raises(SystemExit):
        main(["run", "sphere_spin", "--engine", "native"])
    assert "--engine is no option any more; --fast" in capsys.readouterr().err


@pytest.mark.parametrize("fast", [False, True])
def test_a_simulator_passes_curved_extensions_to_cvxpy(fast):
    scenario = load_scenario("sphere_spin", ["solver.certify=residual"])
    curved = Extension(lambda s: [cp.norm(s.delta_q) <= 1.0])
    settings = {"h": scenario.h, "K_q": scenario.K_q, "certify": "residual", "fast": fast}
    q, goal = scenario.system.q_start, scenario.targets(scenario.h)
    simulator = Simulator(scenario.system, scenario.pairs, extension=lambda q: curved, **settings)
    assert simulator.step(q, goal).solution.certificate.kind == "residual"


NATIVE_RUN = """
import sys
from quasistatic_ref.cli.main import main
status = main(["run", "sphere_spin", "--fast", "--set", "steps=3", "--json", "--out", sys.argv[1]])
heavy = "cvxpy", "qpsolvers", "scipy", "matplotlib", "osqp", "piqp", "clarabel", "numba"
print(status, [name for name in heavy if name in sys.modules])
"""


def test_a_fast_run_imports_neither_cvxpy_nor_what_it_does_not_call(tmp_path):
    """It takes less time than these packages take to be imported."""
    command = [sys.executable, "-c", NATIVE_RUN, str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.stdout.splitlines()[-1] == "0 []", done.stderr
