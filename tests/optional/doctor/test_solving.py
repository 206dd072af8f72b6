"""A backend that fails is named in the summary and in a finding; the run is exact all the same."""

from dataclasses import replace
from itertools import count

import cvxpy
import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.solve import step_problem
from quasistatic_ref.step import problem
from tests.files.urdf.urdf_texts import inertial, joint, link, robot, urdf_of_text
from tests.solvers import Reply

STEPS = 8
LOST = Reply(None, None, False, "lost")


def fail(answers, fails, *backends):
    """Have backends reply that they have lost where `fails` says so of a name."""
    for backend in backends:
        answers(backend, lambda one, own: LOST if fails(one.name) else own())


@pytest.fixture
def failing(answers):
    """A backend that does not solve three of the steps."""
    calls = count()
    fail(answers, lambda name: next(calls) in (1, 4, 5), "daqp")


@pytest.mark.parametrize(
    ("accused", "fails", "remedy"),
    [
        ("clarabel", {"clarabel"}, "choose another backend than clarabel, such as daqp"),
        ("osqp", {"osqp"}, "choose another backend than osqp, such as clarabel or daqp"),
        ("daqp", {"daqp"}, "choose another backend than daqp, such as clarabel"),
        ("daqp", {"daqp", "clarabel", "scs"}, "check masses, lengths and stiffness"),
    ],
)
def test_the_remedy_names_what_solves_the_step_and_never_the_accused(
    answers, accused, fails, remedy
):
    fail(answers, fails.__contains__, "clarabel", "daqp")
    scenario = qr.load_scenario("block_push", {"solver.backend": accused}, steps=3)
    (finding,) = scenario.run(progress=False).findings
    assert finding.remedy.startswith(remedy)


def doubled(monkeypatch, name):
    """Edit step/problem.py: a coefficient of the page, by its name there, counts twice."""
    if name == "K_q":
        fill = step_problem.set_values

        def filled(page, *arguments):
            fill(page, *arguments)
            page.parameters["K_q"].save_value(2 * page.parameters["K_q"].value)

        monkeypatch.setattr(step_problem, "set_values", filled)
        return
    scaled = problem.scaled

    def twice(of, factors, motion):
        return scaled(of, 2 * factors if of == name else factors, motion)

    monkeypatch.setattr(problem, "scaled", twice)


@pytest.mark.parametrize(
    ("name", "model"), [("mu_v", "block_push"), ("mu_omega", "bunny_grasp"), ("K_q", "block_push")]
)
def test_a_page_that_is_another_program_is_said_and_its_solver_is_not_blamed(
    monkeypatch, name, model
):
    """By clarabel, which solves that other program well: to all digits that are asked for."""
    scenario = qr.load_scenario(model, steps=45)
    exact = scenario.run(progress=False)
    doubled(monkeypatch, name)
    run = scenario.run(progress=False)
    assert run["q"].tobytes() == exact["q"].tobytes()
    (finding,) = (one for one in run.findings if one.name == "failing-backend")
    short = np.flatnonzero(run.digits < 6)
    assert len(short)
    assert finding.numbers == {"other": len(short), "step": short[0]}
    assert finding.cause == (
        f"clarabel solved another program than Eqs. (8) and (13) in {len(short)} of 45 steps, the "
        f"first of them step {short[0]}"
    )
    assert "step/problem.py" in finding.remedy


def test_answers_that_satisfy_no_other_program_are_not_blamed_on_the_solver(monkeypatch):
    """Unproved: where residuals of Eqs. (9) to (12) refuse them, the exact method answers."""
    doubled(monkeypatch, "mu_v")
    scenario = qr.load_scenario("block_push", {"solver.certify": "residual"}, steps=30)
    run = scenario.run(progress=False)
    refused = run.header.unanswered
    assert refused
    (finding,) = (one for one in run.findings if one.name == "failing-backend")
    assert finding.numbers == {"other": len(refused), "step": refused[0]}
    assert finding.cause.startswith("clarabel solved another program")


def test_a_page_of_a_users_own_is_compared_and_not_only_that_of_the_file():
    """A row that the step does not have: the block may not move by more than 1 um a step."""
    scenario = qr.load_scenario("block_push")
    simulator = scenario.simulator()
    start = scenario.system.q_start
    targets = scenario.targets
    qr.rollout(simulator, start, targets, 1, progress=False)
    page = simulator.solver.problem
    slow = page.row(page.delta_q_u <= 1e-6)
    page.problem = cvxpy.Problem(page.problem.objective, [*page.problem.constraints, slow])
    run = qr.rollout(simulator, start, targets, 45, progress=False)
    (finding,) = (one for one in run.findings if one.name == "failing-backend")
    assert finding.cause.startswith("clarabel solved another program")


@pytest.mark.parametrize("certify", ["full", "residual"])
@pytest.mark.parametrize("model", ["block_push", "two_finger_pinch"])
def test_a_poor_solver_of_the_right_page_is_blamed(answers, model, certify):
    """Its delta_q is off by a thousandth, its multipliers are those of twice the load."""

    def poor(_, own):
        reply = own()
        return replace(reply, x=1.001 * reply.x, lam=2 * reply.lam)

    answers("clarabel", poor)
    scenario = qr.load_scenario(model, {"solver.certify": certify}, steps=8)
    (finding,) = (
        one for one in scenario.run(progress=False).findings if one.name == "failing-backend"
    )
    assert "other" not in finding.numbers
    assert finding.remedy.startswith("choose another backend than clarabel, such as daqp")


def test_failures_are_in_the_summary_and_in_a_finding_that_is_grave(failing, tmp_path, cli):
    words = f"run block_push --set steps={STEPS} --set solver.backend=daqp --strict --out"
    printed = cli(words, tmp_path, status=1)
    assert f"{STEPS} of {STEPS} steps exact (the backend failed in 3 of them)" in printed.out
    (finding,) = qr.load_trajectory(tmp_path / "block_push.npz").findings
    assert finding.name == "failing-backend"
    assert finding.numbers == {"failed": 3, "short": 0, "step": 1}
    sentence = (
        "grave: daqp failed in 3 of 8 steps, the first of them step 1; the exact method solved "
        "them; choose another backend than daqp, such as clarabel [failing-backend]"
    )
    assert sentence in printed.err


def test_the_steps_have_the_bits_of_a_backend_that_never_fails(failing):
    runs = [
        qr.load_scenario("block_push", {"solver.backend": name}, steps=STEPS).run(progress=False)
        for name in ("daqp", "none")
    ]
    assert runs[0]["q"].tobytes() == runs[1]["q"].tobytes()
    assert runs[1].findings == ()


ARM = robot(
    link("base"),
    link("upper", inertial=inertial("1", ("0.01",) * 3, '<origin xyz="0.2 0 0"/>')),
    link("lower", inertial=inertial("0.5", ("0.01",) * 3, '<origin xyz="0.1 0 0"/>')),
    joint("shoulder", "base", "upper", axis="0 1 0"),
    joint("elbow", "upper", "lower", axis="0 1 0", more='<origin xyz="0.4 0 0"/>'),
)


@pytest.mark.parametrize("backend", ["clarabel", "piqp", "daqp"])
@pytest.mark.parametrize("gravity", [(0.0, 0.0, 0.0), (0.0, 0.0, -9.81)])
def test_an_arm_at_rest_accuses_no_backend(tmp_path, backend, gravity):
    """It sags for some steps, and then its springs bear it: g is zero, or rounding.

    A row that is never reached lets the backend be asked; without rows nobody is.
    """
    arm = qr.Body("arm", urdf_of_text(tmp_path, ARM), actuated="all")
    system = qr.System([arm])
    own = {"h": 0.01, "K_q": np.diag([100.0, 50.0]), "gravity": gravity, "backend": backend}
    simulator = qr.Simulator(system, [], gravity_acts=np.ones(2), **own)
    far = qr.Extension(rows=qr.Extra(("far",), np.array([[1.0, 0.0]]), np.array([-9.0])))
    start = system.q_start
    asked = qr.Simulator(system, [], gravity_acts=np.ones(2), extension=lambda q: far, **own)
    run = qr.rollout(asked, start, start, 40, progress=False)
    assert run.digits.min() >= 8
    assert run.findings == ()
    free = qr.rollout(simulator, start, start, 40, progress=False)
    assert np.isnan(free.digits).all()
    assert free.findings == ()


@pytest.mark.parametrize("fast", [False, True])
@pytest.mark.parametrize("saved_by", ["clarabel", "none"])
def test_no_run_under_residual_ends_for_a_backend_that_fails(answers, fast, saved_by):
    """Every backend but one fails; the exact method needs none."""
    exact = qr.load_scenario("block_push", steps=3).run(progress=False)
    settings = {"solver.backend": "piqp", "solver.certify": "residual"}
    scenario = qr.load_scenario("block_push", settings, fast=fast, steps=3)
    fail(answers, lambda name: name != saved_by, "piqp", "daqp")
    run = scenario.run(progress=False)
    assert run.header.unanswered == (0, 1, 2)
    if saved_by != "none":
        assert np.isnan(run.digits).all()
    assert [one.name for one in run.findings] == ["failing-backend"]
    other = "the exact method" if saved_by == "none" else "another backend or the exact method"
    assert f"step 0; {other} solved them" in run.findings[0].sentence
    assert set(run.certificate) == {"exact" if saved_by == "none" else "residual"}
    np.testing.assert_allclose(run.q, exact.q, atol=1e-9)
