"""Whatever a solver does, it is reported as what it is, and the study goes on."""

import json
import os
import signal
import stat
import sys
import threading
import time

import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab import processes
from quasistatic_ref.lab.folders import CONTACT_QP, problem_set_folder
from quasistatic_ref.lab.study.calling.solvers import SETTINGS, Solver
from quasistatic_ref.lab.study.file.study_file import Limits
from quasistatic_ref.lab.study.measuring.keeper import Keeper, Request
from quasistatic_ref.lab.study.measuring.measure import measured_row
from quasistatic_ref.lab.study.measuring.worker import GRACE
from quasistatic_ref.lab.study.problems.folder import set_read
from tests.lab.study.planted import FAKES

DEFAULT = SETTINGS[0]

# How each of them must be reported: outcome, a part of what it claimed, "said optimal", "wrong".
REPORTED = {
    "honest": ("solved", "returned", True, False),
    "exits": ("crashed", "status 7", False, False),
    "segfaults": ("crashed", "signal 11", False, False),
    "nan": ("nan", "returned", True, True),
    "nan_multipliers": ("nan", "returned", True, True),
    "too_long": ("wrong_shape", "of shapes [16] and [58] in place of [15]", False, False),
    "no_pair": ("wrong_shape", "returned a float in place of (x, z)", False, False),
    "no_numbers": ("wrong_shape", "of shapes [0, 0]", False, False),
    "liar": ("solved", "returned", True, True),
    "raises": ("failed", "RuntimeError: no licence found", False, False),
    "gives_up": ("failed", "returned None", False, False),
    "prints": ("solved", "returned", True, False),
    "spoils": ("solved", "returned", True, False),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("planted")
    (place / "planted_solvers.py").write_text(FAKES)
    return place


LIMITS = Limits(30.0, 30.0, 2)
"""30 s a call and 30 s its first one; two timed calls."""


def row_of(solver, problem, folder, limits=LIMITS, **options):
    """The row of a planted solver in a process of its own."""
    solver = fake(solver) if isinstance(solver, str) else solver
    with Keeper(solver, folder, **options) as keeper:
        return measured_row(keeper, problem, DEFAULT, "natural", False, limits)


def fake(name):
    return Solver(name, "callable", f"planted_solvers:{name}")


@pytest.mark.parametrize("name", REPORTED)
def test_a_planted_solver_is_reported_as_what_it_is(name, harmless, problem):
    outcome, claimed, said_optimal, wrong = REPORTED[name]
    row = harmless(name, problem)
    assert (row["outcome"], row["said_optimal"], row["wrong"]) == (outcome, said_optimal, wrong)
    assert claimed in row["claimed"]


def test_a_looping_solver_whose_keeper_was_killed_ends_itself(folder, problem):
    keeper = Keeper(fake("loops_in_c"), folder)
    with keeper:
        keeper.start()
        keeper._outbox.send((1, problem.form))
        request = vars(Request(DEFAULT, 0.1)) | {"form": 1, "patience": 0.1}
        keeper._outbox.send(request)
        assert keeper._process.process.wait(timeout=GRACE + 15) == -signal.SIGALRM


DIES_BEFORE_A_CALL = """
import os
from multiprocessing.connection import Connection

Connection.recv = lambda self: os._exit(7)  # the next message ends the process: no call is made

def never(P, q, G, h):
    pass
"""


def test_a_process_that_ends_before_its_first_call_is_a_crash(tmp_path, problem):
    (tmp_path / "planted_ending.py").write_text(DIES_BEFORE_A_CALL)
    row = row_of(Solver("never", "callable", "planted_ending:never"), problem, tmp_path)
    assert (row["outcome"], row["calls"]) == ("crashed", 0)
    assert "status 7" in row["claimed"]


EXECUTABLE = """#!{python}
import json, os, sys
qp = json.loads(sys.stdin.readline())
assert sorted(qp) == ["A", "H", "b", "g"]
{body}
"""
BODIES = {
    "writes": (
        'print(json.dumps({"delta_q": [0.0] * len(qp["g"]), "lam": [0.0] * len(qp["b"]), '
        '"iterations": 4, "seconds": 0.25}))',
        ("solved", "optimal", True, True),
    ),
    "says infeasible": (
        'print(json.dumps({"status": "infeasible"}))',
        ("failed", "infeasible", False, True),
    ),
    "writes no JSON": ('print("hello")', ("failed", "no usable JSON", False, False)),
    "fails": ('sys.exit("no licence")', ("failed", "exit status 1: no licence", False, False)),
    "crashes": ("os.abort()", ("crashed", "signal 6", False, False)),
    "hangs": ("import time; time.sleep(60)", ("timeout", "killed after 1 s", False, False)),
}


@pytest.fixture(scope="module")
def executable(tmp_path_factory, problem):
    """A function: the row of an executable with a body, and its folder; one process calls all."""
    folder = tmp_path_factory.mktemp("executable")
    path = folder / "solver"
    path.touch(stat.S_IRWXU)
    with Keeper(Solver("mine", "executable", ("./solver",)), folder) as keeper:

        def row_of_body(body, limit=30.0, units="natural"):
            path.write_text(EXECUTABLE.format(python=sys.executable, body=body))
            keeper.seen.clear()
            return measured_row(
                keeper, problem, DEFAULT, units, False, Limits(limit, limit, 1)
            ), folder

        yield row_of_body


@pytest.mark.parametrize("name", BODIES)
def test_an_executable_reads_and_writes_json(name, executable):
    body, (outcome, claimed, said_optimal, wrong) = BODIES[name]
    row, _ = executable(body, 1.0 if name == "hangs" else 30.0)
    assert (row["outcome"], row["said_optimal"], row["wrong"]) == (outcome, said_optimal, wrong)
    assert claimed in row["claimed"]
    if name == "writes":
        assert (row["iterations"], row["seconds"]["solver"]) == (4, 0.25)


SERVER = """#!{python}
import json, sys
for count, line in enumerate(sys.stdin, 1):
    qp = json.loads(line)
    print(json.dumps(dict(delta_q=[0.0] * len(qp["g"]), iterations=count)), flush=True)
"""


def test_one_process_of_a_program_serves_many_problems(tmp_path, problem):
    """A call that warms up, one that is graded, and one exchange of two: its count goes on."""
    path = tmp_path / "server"
    path.touch(stat.S_IRWXU)
    path.write_text(SERVER.format(python=sys.executable))
    with Keeper(Solver("mine", "executable", ("./server",)), tmp_path) as keeper:
        rows = [measured_row(keeper, problem, DEFAULT, units, False, Limits(30.0, 30.0, 2))
                for units in ("natural", "raw")]  # fmt: skip
    counts = [row["iterations"] for row in rows]
    assert counts[0] >= 2
    assert counts[1] >= counts[0] + rows[0]["calls"] + 2


def test_an_executable_gets_the_numbers_of_the_problem_to_the_last_bit(executable, problem):
    body = 'open("seen.json", "w").write(json.dumps(qp)); print("{}")'
    _, folder = executable(body, units="raw")
    seen = json.loads((folder / "seen.json").read_text())
    for name in ("H", "g", "A", "b"):
        assert seen[name] == (getattr(problem.form, name) + 0.0).tolist()


@pytest.mark.parametrize(
    ("solver", "says"),
    [
        (Solver("mine", "callable", "planted_solvers:np"), "is not a function"),
        (Solver("mine", "executable", ("./missing",)), "there is no such program"),
    ],
)
def test_a_solver_that_cannot_be_reached_is_one_sentence(solver, says, folder, problem):
    with pytest.raises(InputError, match=says) as refused:
        row_of(solver, problem, folder)
    assert "\n" not in str(refused.value)


# -- What fools or hurts a study -----------------------------------------------------------------


def test_no_answer_is_to_be_found_in_the_process_of_a_solver(folder, problem):
    row = row_of("peeks", problem, folder)
    assert row["digits"]["delta_q"] < 1
    assert row["wrong"]


def test_a_clock_that_was_stopped_is_not_believed(folder, harmless, problem):
    """It works for 3 ms; its process says 0, and the time is that of the exchange with it."""
    row = row_of("stops_the_clock", problem, folder)
    assert row["clock_agrees"] is False
    assert row["seconds"]["call"] >= 3e-3
    honest = harmless("honest", problem)
    assert honest["clock_agrees"] is True
    assert 0 < honest["seconds"]["low"] <= honest["seconds"]["call"] <= honest["seconds"]["high"]


def alive(folder):
    pids = [int(line) for line in (folder / "detached").read_text().split()]
    assert pids
    return [pid for pid in pids if os.path.exists(f"/proc/{pid}") and not zombie(pid)]


def zombie(pid):
    with open(f"/proc/{pid}/stat") as file:
        return file.read().rpartition(")")[2].split()[0] == "Z"


def test_what_a_solver_leaves_behind_is_ended(folder, problem):
    row_of("detaches_and_dies", problem, folder)
    end = time.monotonic() + 10
    while alive(folder) and time.monotonic() < end:
        time.sleep(0.05)
    assert alive(folder) == []


def test_a_process_that_is_being_started_is_known_by_its_token(tmp_path, monkeypatch):
    """For a moment Linux shows an empty environment, here for 20 ms."""
    monkeypatch.setattr(processes, "PROC", tmp_path)
    (tmp_path / "7").mkdir()
    environment = tmp_path / "7" / "environ"
    environment.touch()
    started = threading.Timer(0.02, environment.write_text, [f"A=b\0{processes.TOKEN}=mine\0"])
    started.start()
    assert processes.marked_processes("mine") == [7]
    started.join()


def test_a_solver_that_eats_memory_is_ended_and_its_memory_reported(folder, harmless, problem):
    row = row_of("eats", problem, folder, memory=3e8)
    assert row["outcome"] == "memory"
    assert "0.3 GB" in row["claimed"]
    assert 1e7 < harmless("honest", problem)["memory"] < 1e9


def test_what_is_no_reply_is_a_crash_and_nothing_is_unpickled(folder, problem):
    assert row_of("scribbles", problem, folder)["outcome"] == "crashed"


def test_the_worst_of_repeated_answers_is_graded(folder, problem):
    row = row_of("second_thoughts", problem, folder)
    assert row["wrong"]


def test_the_first_call_of_a_shape_is_outside_of_the_time_limit(folder, problem):
    """It takes 1 s where 0.5 s are allowed, once."""
    row = row_of("compiles", problem, folder, Limits(0.5, 10.0, 2))
    assert row["outcome"] == "solved"
    assert row["seconds"]["warm_up"] >= 1.0 > row["seconds"]["first"]


@pytest.fixture(scope="module")
def none_to_find():
    """A problem without a solution."""
    (found,) = set_read(problem_set_folder(CONTACT_QP), ids=["infeasible/0.01/0"])
    assert not found.feasible
    return found


JUDGED = {  # on a problem with a solution, and on one without: (says there is none, wrong)
    "says_there_is_none": ((True, True), (True, False)),
    "liar": ((False, True), (False, True)),
    "gives_up": ((False, False), (False, False)),
}


@pytest.mark.parametrize("name", JUDGED)
def test_a_claim_that_there_is_no_solution_is_judged(name, harmless, problem, none_to_find):
    for judged, (said, wrong) in zip((problem, none_to_find), JUDGED[name], strict=True):
        row = harmless(name, judged)
        assert (row["said_infeasible"], row["wrong"]) == (said, wrong)
