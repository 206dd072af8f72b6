"""Solvers that fool or hurt a study, planted: each is found out, and costs no other solver."""

import os
import time

import pytest

from quasistatic_ref.lab.study.calling.solvers import SETTINGS, Solver
from quasistatic_ref.lab.study.measuring.keeper import Keeper
from quasistatic_ref.lab.study.measuring.measure import Limits, measured
from quasistatic_ref.lab.study.problems.families.dials import one_turned
from quasistatic_ref.lab.study.problems.making import problem_of
from quasistatic_ref.lab.study.store.store import contents
from tests.lab.study.planted import FAKES

DEFAULT = SETTINGS[0]
LIMITS = Limits(20.0, 20.0, 2)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "planted_solvers.py").write_text(FAKES)
    return tmp_path


def row_of(name, problem, folder, limits=LIMITS, **options):
    with Keeper(Solver(name, "callable", f"planted_solvers:{name}"), folder, **options) as keeper:
        return measured(keeper, problem, DEFAULT, "natural", False, limits)


def test_no_answer_is_to_be_found_in_the_process_of_a_solver(folder, problem):
    row = row_of("peeks", problem, folder)
    assert row["digits"]["delta_q"] < 1
    assert row["wrong"]


def test_a_clock_that_was_stopped_is_not_believed(folder, harmless, problem):
    """It works for 3 ms; its process says 0."""
    row = row_of("stops_the_clock", problem, folder)
    assert row["clock_agrees"] is False
    assert row["seconds"]["call"] > 1e-3
    honest = harmless("honest", problem)
    assert honest["clock_agrees"] is True
    assert 0 < honest["seconds"]["low"] <= honest["seconds"]["call"] <= honest["seconds"]["high"]
    assert honest["calls"] >= LIMITS.repetitions


def test_clocks_of_warm_calls_are_not_compared(harmless, problem):
    """An exchange holds the solves that warm calls start from, so its length confirms nothing."""
    row = harmless("honest", problem, warm=True)
    assert row["outcome"] == "solved"
    assert row["clock_agrees"] is None


def test_multipliers_that_are_none_are_found_beside_a_right_answer(harmless, problem):
    row, honest = (harmless(name, problem) for name in ("minus_one", "honest"))
    assert row["digits"]["delta_q"] == honest["digits"]["delta_q"] > 12
    assert row["wrong_multipliers"]
    assert row["digits"]["multipliers"] < 1
    assert not honest["wrong_multipliers"]


def alive(folder):
    pids = [int(line) for line in (folder / "detached").read_text().split()]
    assert pids
    return [pid for pid in pids if os.path.exists(f"/proc/{pid}") and not zombie(pid)]


def zombie(pid):
    with open(f"/proc/{pid}/stat") as file:
        return file.read().rpartition(")")[2].split()[0] == "Z"


@pytest.mark.parametrize("name", ["detaches", "detaches_and_dies"])
def test_what_a_solver_leaves_behind_is_ended(name, folder, problem):
    row_of(name, problem, folder)
    end = time.monotonic() + 10
    while alive(folder) and time.monotonic() < end:
        time.sleep(0.05)
    assert alive(folder) == []


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
    found = problem_of(one_turned("infeasible", 1e-2, 0, 1))
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


MIXED = """
time_limit = 0.3
warm_up = 2.0
budget = 6.0
repetitions = 2
[problems]
families = { contacts = 4 }
[solvers.slow]
callable = "planted_solvers:slow"
[solvers.missing]
callable = "no_such_module:solve"
[solvers.honest]
callable = "planted_solvers:honest"
[[runs]]
solvers = ["slow", "missing", "honest", "qpsolvers:daqp"]
again = 0
"""


def test_bad_solvers_cost_themselves_only(run, tmp_path):
    """One is always too late, 2.3 s a problem, so that three exceed the budget; one is missing."""
    rows = run(MIXED)
    by_name = {name: [r["outcome"] for r in rows if r["solver"] == name]
               for name in ("slow", "missing", "honest", "daqp")}  # fmt: skip
    assert by_name["honest"] == by_name["daqp"] == 4 * ["solved"]
    assert by_name["missing"] == []
    assert set(by_name["slow"]) == {"not_run_budget", "timeout"}
    (reason,) = contents(tmp_path / "store").unreached.values()
    assert "cannot be imported" in reason
