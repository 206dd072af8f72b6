"""Quadratic costs of a user's own are part of H and g: the optimum is exact with every backend."""

import json
from fractions import Fraction
from hashlib import sha256

import cvxpy as cp
import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import (
    BackendError,
    Extension,
    Extra,
    RunFailed,
    StepDataError,
    load_trajectory,
    rollout,
    save_trajectory,
    solve_step,
)
from quasistatic_ref.certify.groups import groups
from quasistatic_ref.files.step import step_from_record
from tests.closeness import assert_relative, assert_same
from tests.helpers import REQUIRED, pinch, point_on_floor, random_step, verify_refusal
from tests.made import free_step, no_contacts, solution_text, step_text
from tests.oracles.rational_kkt import exact
from tests.oracles.records import value_at, with_value
from tests.tolerances import OPTIMUM
from validation import check_solution as checker

M, H, W = 0.3, 0.01, 50.0
FORCE = (0.7, -0.4, -0.3 * 9.81)
TARGET = np.array([2e-3, -1e-3, 5e-3])
CEILING = 1e-3


def regularised(s):
    """W |delta_q - TARGET|^2 below a ceiling, which the target is above."""
    return [s.delta_q[2] <= CEILING, W * cp.sum_squares(s.delta_q - TARGET)]


def by_hand():
    """delta_q of a free point under FORCE with that cost, and the multiplier of the ceiling.

    (m / h + 2 W) delta_q = h f + 2 W t, but delta_q_z = c: lam = h f_z + 2 W t_z - (m / h + 2 W) c.
    """
    h, m, w = exact([H, M, W])
    stiff = m / h + 2 * w
    load = h * exact(FORCE) + exact(2 * W * TARGET)
    x, y, _ = (load / stiff).astype(float)
    return [x, y, CEILING], float(load[2] - stiff * Fraction(CEILING))


@pytest.mark.parametrize("backend", REQUIRED)
def test_a_bound_regularised_step_is_that_by_hand_with_every_backend(backend):
    step = point_on_floor(m=M, mu_v=0.0, phi=1.0, force=FORCE, h=H)
    solution = solve_step(step, backend, extension=Extension(regularised))
    delta_q, lam = by_hand()
    assert solution.certificate.kind == "exact"
    assert solution.delta_q.tolist() == delta_q
    assert solution.lam_extra.tolist() == [lam]


def quadratic_terms(step):
    """Costs that CVXPY states in its ways, each with its H and g by hand."""
    n = step.n_v
    C = np.arange(2.0 * n).reshape(2, n) / 8 - 1
    d = np.array([0.25, -0.5])
    S = np.diag(np.arange(1.0, n + 1)) + 0.5
    H_of_C, g_of_C = 2 * C.T @ C, 2 * C.T @ d

    def of_variable(s, **sign):
        z = cp.Variable(2, **sign)
        return [z == C @ s.delta_q - d, cp.sum_squares(z)]

    return {
        "squares": (lambda s: [cp.sum_squares(C @ s.delta_q - d)], H_of_C, g_of_C),
        "a form": (lambda s: [cp.quad_form(s.delta_q, S)], 2 * S, np.zeros(n)),
        "a line": (lambda s: [C[0] @ s.delta_q], np.zeros((n, n)), -C[0]),
        "a variable bound by equations": (of_variable, H_of_C, g_of_C),
        "a variable with a sign": (lambda s: of_variable(s, nonpos=True), H_of_C, g_of_C),
    }  # fmt: skip


NAMES = tuple(quadratic_terms(point_on_floor()))


@pytest.mark.parametrize("name", NAMES)
def test_a_quadratic_cost_is_data_of_the_step(rng, name):
    step = random_step(rng)
    terms, H_cost, g_cost = quadratic_terms(step)[name]
    full = solve_step(step, extension=Extension(terms)).step
    assert_same(full.extra.H, H_cost)
    assert_same(full.extra.g, g_cost)
    form, plain = qr.standard_form(full), qr.standard_form(step)
    assert_same(form.H, plain.H + H_cost)
    assert_same(form.g, plain.g + g_cost)


def test_equations_that_bind_no_variable_stay_equations(rng):
    step = random_step(rng)

    def twice(s):
        z = cp.Variable()
        return [z == s.delta_q[0] - 1e-3, z == 2 * s.delta_q[1], cp.square(z)]

    found = solve_step(step, extension=Extension(twice))
    same = Extension(lambda s: [s.delta_q[0] - 1e-3 == 2 * s.delta_q[1],
                                cp.square(s.delta_q[0] - 1e-3)])  # fmt: skip
    assert found.certificate.kind == "exact"
    assert_relative(found.delta_q, solve_step(step, extension=same).delta_q, OPTIMUM)


def unbound(s):
    z = cp.Variable()
    return [z >= s.delta_q[0], cp.square(z)]


NOT_QUADRATIC = {
    "abs": lambda s: [cp.abs(s.delta_q[0])],
    "log": lambda s: [-cp.log(1 + s.delta_q[0])],
    "a variable that an inequality bounds": unbound,
    "a square and a ball": lambda s: [cp.sum_squares(s.delta_q), cp.norm(s.delta_q) <= 1.0],
}


@pytest.mark.parametrize("terms", NOT_QUADRATIC.values(), ids=NOT_QUADRATIC)
def test_other_costs_and_variables_are_solved_as_conic_programs(rng, terms):
    step = random_step(rng)
    found = solve_step(step, extension=Extension(terms))
    assert found.step == step
    assert found.certificate.kind == "residual"
    assert max(found.certificate.residuals.values()) < OPTIMUM
    with pytest.raises(BackendError, match="constraints or costs needs one of clarabel, scs"):
        solve_step(step, "piqp", extension=Extension(terms))


def with_cost(step, **cost):
    """A step with a cost of a user's own, and no rows."""
    return step.replace(extra=Extra((), np.zeros((0, step.n_v)), [], **cost))


def two_points(coupling):
    """Two free points, which nothing joins but a cost of `coupling` |x - y|^2."""
    H_cost = 2 * coupling * np.kron([[1.0, -1.0], [-1.0, 1.0]], np.eye(3))
    step = free_step(M * np.eye(6), [*FORCE, 0.0, 0.0, 0.0], no_contacts(6), H)
    return with_cost(step, H=H_cost)


def test_a_cost_couples_two_bodies():
    """With stiff = m / h and k = 2 coupling: x + y = h f / stiff, x - y = h f / (stiff + 2 k)."""
    step = two_points(W)
    assert len(groups(step)) == 3  # one for each axis
    h, m, w = exact([H, M, W])
    both, apart = (h * exact(FORCE) / stiff for stiff in (m / h, m / h + 4 * w))
    expected = np.concatenate([both + apart, both - apart]) / 2
    for backend in REQUIRED:
        solution = solve_step(step, backend)
        assert solution.certificate.kind == "exact"
        assert solution.delta_q.tolist() == expected.astype(float).tolist()
    assert len(groups(two_points(0.0))) == 6


def bounded_pinch(s):
    return [s.delta_q_u[2] >= -1e-4, 50.0 * cp.sum_squares(s.delta_q_u[:3] - s.delta_q_u[3:])]


def refused_by(folder, step, solution):
    """Whether `verify` and the checker refuse a step with a solution that says it is of it."""
    text = step_text(step_from_record(step))
    solution = solution | {"step_sha256": sha256(text.encode()).hexdigest()}
    by_verify = verify_refusal(folder, text, json.dumps(solution)) is not None
    paths = folder / "step.json", folder / "solution.json"  # which that has written
    return by_verify, checker.main(*map(str, paths)) == 1


def test_verify_and_the_checker_read_the_cost(tmp_path):
    solved = solve_step(pinch(grip=5.0, offset=0.2), extension=Extension(bounded_pinch))
    step = solved.step
    record = json.loads(step_text(step))
    solution = json.loads(solution_text(solved))
    assert list(record["extra"]) == ["names", "A", "b", "H", "g"]
    assert step_from_record(record) == step
    assert refused_by(tmp_path, record, solution) == (False, False)
    for place in (("H", -1, -1), ("g", -1)):
        value = value_at(record["extra"], place) + 0.5
        changed = with_value(record, ("extra", *place), value)
        assert refused_by(tmp_path, changed, solution) == (True, True)
    del record["extra"]["H"], record["extra"]["g"]
    assert refused_by(tmp_path, record, solution) == (True, True)


def test_a_file_may_leave_out_h_or_g():
    record = json.loads(step_text(point_on_floor()))
    for cost in ({"g": [1.0, 0.0, 0.0]}, {"H": np.eye(3).tolist()}):
        record["extra"] = {"names": [], "A": [], "b": []} | cost
        step = step_from_record(record)
        assert step.extra.H.shape == (3, 3)
        assert step.extra.g.shape == (3,)
        assert checker.step_read(record) == json.loads(step_text(step))


REFUSED = {
    "not symmetric": (np.eye(3) + np.eye(3, k=1), "extra.H: must be symmetric"),
    "a negative entry": (-np.eye(3), "a cost must be convex"),
    "an indefinite sum": (
        100.0 * (np.ones((3, 3)) - np.eye(3)),
        "leave the H of the step positive",
    ),
    "no number": (np.full((3, 3), np.nan), "finite numbers only"),
}


@pytest.mark.parametrize(("H_cost", "words"), REFUSED.values(), ids=REFUSED)
def test_a_cost_that_is_not_convex_or_of_the_step_is_refused(H_cost, words):
    step = point_on_floor()
    with pytest.raises(StepDataError, match=words):
        with_cost(step, H=H_cost)


def test_a_cost_too_large_for_float64_beside_h_is_solved_as_before():
    """1e14 (x + y / 3)^2 leaves of m / h = 30 nothing along (1, -3)."""
    step = point_on_floor(force=FORCE)
    steep = Extension(lambda s: [1e17 * cp.square(s.delta_q[0] + s.delta_q[1] / 3)])
    assert solve_step(step, extension=steep).step == step


def spring(q):
    """A soft spring of a user's own, as a cost: it pulls the sphere up to 1 mm a step."""
    return Extension(lambda s: [40.0 * cp.square(s.delta_q[2] - 1e-3)])


@pytest.mark.parametrize("settings", [[], ["cone=ellipsoid"], ["law=coulomb"]], ids=str)
def test_a_run_with_a_cost_is_recorded_and_replayed(tmp_path, settings):
    scenario = qr.load_scenario("sphere_spin", ["steps=3", *settings])
    simulator = scenario.simulator(spring)
    run = rollout(simulator, scenario.system.q_start, scenario.targets, 3)
    back = load_trajectory(save_trajectory(tmp_path / "run.npz", run))
    assert back == run
    step = back.step_data(2)
    assert step.extra.H[2, 2] == 80.0
    assert_same(back["H"][2], step.H)
    assert_same(back["g"][2], qr.standard_form(step).g)
    if not settings:
        assert_same(solve_step(step, "daqp").delta_q, run["delta_q"][2])
        assert set(run["certificate"].tolist()) == {"exact"}
        fast = qr.load_scenario("sphere_spin", ["steps=3"], fast=True).simulator(spring)
        other = rollout(fast, scenario.system.q_start, scenario.targets, 3)
        for name in ("q", "delta_q", "H", "g", "extra_H", "extra_g"):
            assert_same(other[name], run[name])


def test_every_step_of_a_run_has_a_cost_or_none():
    scenario = qr.load_scenario("sphere_spin", ["steps=2"])
    first = scenario.system.q_start

    def at_first(q):
        return spring(q) if (q == first).all() else Extension()

    simulator = scenario.simulator(at_first)
    with pytest.raises(RunFailed, match="no quadratic cost in step 1, the step before has one"):
        rollout(simulator, first, scenario.targets, 2)


def test_forces_of_a_step_with_a_cost_balance_its_load():
    """A ball of weight m g whose cost pushes it down with W / h as well: f_n = m g + W / h."""
    step = point_on_floor(m=M, force=(0.0, 0.0, -M * 9.81), h=H)
    solution = solve_step(with_cost(step, g=[0.0, 0.0, -H * 2.0]))
    assert_relative(solution.wrench[0, 2], M * 9.81 + 2.0, OPTIMUM)
    assert_relative(solution.forces[0, 2], M * 9.81 + 2.0, 1e-5)
