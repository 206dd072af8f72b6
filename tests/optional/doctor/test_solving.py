"""A backend that fails is named in the summary and in a finding; the run is exact all the same."""

from itertools import count

import numpy as np
import pytest

import quasistatic_ref as qr
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
