"""Solvers that the table does not have: CVXPY's, qpsolvers', and functions of the user's."""

import contextvars
import decimal
import json
import pickle
import re
import sys
from itertools import product

import cvxpy as cp
import numpy as np
import pytest
import qpsolvers

import quasistatic_ref as qr
from quasistatic_ref.cli.main import main
from tests.cases import cases
from tests.closeness import assert_within
from tests.helpers import one_sentence, pinch
from tests.solvers import solver_for

STEP = pinch(grip=1.0)
EXACT = qr.solve_step(STEP)


def by_daqp(P, q, G, h):
    """A function that solves."""
    answer = qpsolvers.solve_problem(qpsolvers.Problem(P, q, G, h), "daqp")
    return answer.x, answer.z, "optimal"


MINE = """
import os
from tests.solve.test_any_solver import by_daqp as solve

def prints(P, q, G, h):
    os.write(1, b"noise\\n")
    print("more noise")
    return solve(P, q, G, h)

def gives_up(P, q, G, h):
    return None, None, "tired"

number = 3
"""


@pytest.fixture
def mine(tmp_path, monkeypatch):
    """A file of functions and a step, in the folder where commands run."""
    qr.save_step(tmp_path / "step.json", STEP)
    (tmp_path / "mine.py").write_text(MINE)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])
    yield tmp_path
    sys.modules.pop("mine", None)


def test_a_function_solves_steps_as_a_backend_does():
    solution = qr.solve_step(STEP, by_daqp)
    assert solution.delta_q.tobytes() == EXACT.delta_q.tobytes()
    said = solution.statistics
    assert (said.interface, said.status) == ("function", "optimal")
    assert said.digits > 9
    assert not said.unanswered
    residual = qr.solve_step(STEP, by_daqp, certify="residual")
    assert_within(residual.delta_q, EXACT.delta_q, 1e-9)
    solver = pickle.loads(pickle.dumps(solver_for(STEP, by_daqp)))
    assert solver.fits(STEP)
    again = qr.solve_step(STEP, solver)
    assert again.delta_q.tobytes() == EXACT.delta_q.tobytes()


@pytest.mark.parametrize("name", ["mine:solve", "mine.py:solve"])
def test_a_function_has_a_name_on_the_command_line(name, mine, cli):
    assert "correct digits" in cli("solve step.json --backend", name).err
    run = qr.load_scenario("sphere_spin", {"solver.backend": name}, steps=2).run()
    assert set(run.certificate) == {"exact"}


def test_a_function_without_an_answer_has_no_digits(mine, cli):
    assert "correct digits" not in cli("solve step.json --backend mine:gives_up").err


def test_the_output_of_a_function_comes_not_among_the_answers(mine, capfd):
    (mine / "loud.py").write_text(f"print('noise of the module')\n{MINE}")
    assert main(["solve", "step.json", "--backend", "loud.py:prints"]) == 0
    said = capfd.readouterr()
    assert json.loads(said.out)["status"] == "optimal"
    assert "noise of the module" in said.err
    assert "more noise" in said.err


def test_a_module_that_ends_its_process_is_a_sentence(mine, cli):
    (mine / "ends.py").write_text("raise SystemExit(0)")
    said = cli("solve", "step.json", "--backend", "ends.py:solve", status=2).err
    assert "cannot be imported: RuntimeError: SystemExit: 0" in said


ABSENT = {
    "away.py:solve": "cannot be imported: FileNotFoundError: [Errno 2] No such file or directory",
    "mine.py:away": "cannot be imported: AttributeError: module 'mine' has no attribute 'away'",
    "away:solve": "cannot be imported: ModuleNotFoundError: No module named 'away'",
    "mine.py:number": "must be a function",
}
COMMANDS = ("run sphere_spin --out made", "demo --out made", "solve step.json -o made")
A_SWEEP = "run sphere_spin --out made --sweep h=0.01,0.02"  # which asks in other processes


@pytest.mark.parametrize(
    ("command", "name"), [*product(COMMANDS, ABSENT), (A_SWEEP, "away.py:solve")]
)
def test_a_function_that_is_not_there_is_said_before_anything_is_made(command, name, mine, cli):
    said = cli(command, "--backend", name, status=2).err
    assert f"--backend {name}: {ABSENT[name]}" in said
    assert not (mine / "made").exists()


WRONG = {
    "complex": (lambda q, h: (q + 1e-9j, h, "optimal"), "0 and 12 real numbers in place of"),
    "words": (lambda q, h: (["1"] * len(q), h, "optimal"), "real numbers in place of"),
    "two statuses": (lambda q, h: (q, h, np.array(["optimal", "x"])), "a ndarray in place"),
    "no word": (lambda q, h: (q, h, 1), "returned a int in place of a status"),
    "an end": (lambda q, h: sys.exit(0), "SystemExit: 0"),
    "no UTF-8 in a status": (lambda q, h: (None, None, "caf\udce9"), r"caf\udce9"),
    "of another shape": (lambda q, h: (q[:1], h, "optimal"), "in place of"),
    "no three": (lambda q, h: q, "in place of"),
    "not finite": (lambda q, h: (q * np.nan, h, "optimal"), "not finite"),
    "raised": (lambda q, h: 1 / 0, "division by zero"),
}


@cases("answer, says", WRONG)
def test_the_answer_of_a_function_is_not_believed(answer, says):
    def function(P, q, G, h):
        return answer(q, h)

    solution = qr.solve_step(STEP, function)
    assert solution.delta_q.tobytes() == EXACT.delta_q.tobytes()
    said = solution.statistics
    assert re.match(f"failed: .*{re.escape(says)}", said.status)
    assert (said.unanswered, said.digits) == (True, None)
    with pytest.raises(qr.StepNotSolved, match=re.escape(says)) as caught:
        qr.solve_step(STEP, function, certify="off")
    assert str(caught.value).encode()


def test_digits_of_an_answer_of_another_status_are_measured():
    said = qr.solve_step(STEP, lambda *program: (*by_daqp(*program)[:2], "almost")).statistics
    assert said.status == "failed: almost"
    assert said.digits > 9
    assert not said.unanswered


LIES = {
    "a motion a little off": lambda x, z: (x + 1e-4, z),
    "no multipliers": lambda x, z: (x, 0 * z),
    "no motion": lambda x, z: (0 * x, z),
    "a motion whose residual is no number": lambda x, z: (x + 1.7e308, z),
}


@cases("lie", LIES)
def test_an_optimal_status_is_no_evidence(lie):
    def liar(*program):
        x, z, status = by_daqp(*program)
        return *lie(x, z), status

    assert qr.solve_step(STEP, liar).delta_q.tobytes() == EXACT.delta_q.tobytes()
    with pytest.raises(qr.StepNotSolved) as caught:
        qr.solve_step(STEP, liar, certify="residual")
    assert caught.value.step is STEP
    assert not caught.value.residuals.worst <= 1e-6
    believed = qr.solve_step(STEP, liar, certify="off").certificate
    assert believed.kind == "none"
    assert not believed.residuals


NOT_THERE = ["missing:solve", "mine:missing", "mine:number", "none.py:solve", "mine.py:number"]


@pytest.mark.parametrize("name", NOT_THERE)
def test_a_function_that_is_not_there_is_named(name, mine, cli):
    assert name in one_sentence(cli("solve", "step.json", "--backend", name, status=2).err)


@pytest.mark.parametrize("name", NOT_THERE)
@pytest.mark.parametrize("sweep", [[], ["--sweep", "steps=1,2", "--jobs", "1"]], ids=["", "sweep"])
def test_a_run_by_a_function_that_is_not_there_makes_no_folder(name, sweep, mine, cli):
    said = cli("run", "sphere_spin", "--out", "here", "--backend", name, *sweep, status=2).err
    assert name in one_sentence(said)
    assert not (mine / "here").exists()


def test_a_function_takes_neither_cones_nor_costs():
    with pytest.raises(qr.BackendError, match="function"):
        qr.solve_step(STEP.replace(cone="ellipsoid"), by_daqp)
    cone = qr.Extension(lambda s: [cp.norm(s.delta_q_a) <= 1e-3])
    with pytest.raises(qr.BackendError, match="function"):
        qr.solve_step(STEP, by_daqp, extension=cone)


MARK = contextvars.ContextVar("MARK", default="nothing")


@pytest.mark.parametrize("more", [{}, {"extension": qr.Extension()}], ids=["alone", "extended"])
def test_a_function_runs_in_the_context_of_who_solves_the_step(more):
    """Its context variables, decimal precision and NumPy's errors, also within another solve."""
    seen = []

    def settings():
        return MARK.get(), decimal.getcontext().prec, np.geterr()["invalid"]

    def inner(P, q, G, h):
        seen.append(settings())
        return by_daqp(P, q, G, h)

    def outer(P, q, G, h):
        seen.append(settings())
        with decimal.localcontext(prec=9), np.errstate(invalid="print"):
            qr.solve_step(STEP, inner)
        return by_daqp(P, q, G, h)

    def of_user():
        MARK.set("the user's")
        with decimal.localcontext(prec=50), np.errstate(invalid="raise"):
            return qr.solve_step(STEP, outer, **more)

    answer = contextvars.copy_context().run(of_user)
    assert seen == [("the user's", 50, "raise"), ("the user's", 9, "print")]
    assert answer.delta_q.tobytes() == EXACT.delta_q.tobytes()
    assert np.geterr()["invalid"] == settings()[2] != "print"
