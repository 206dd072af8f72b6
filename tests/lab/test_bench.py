"""The benchmark runs, judges by its limits, and compares what gives the same answers."""

import json

import numpy as np
import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.lab.bench.acceptance import promises
from quasistatic_ref.lab.bench.derived import MAPPED, STEP
from quasistatic_ref.lab.bench.grasp import bare_daqp, places
from quasistatic_ref.lab.bench.report import promise_rows
from quasistatic_ref.lab.bench.timing import in_turn, least
from quasistatic_ref.lab.bench.whole_run import WALL
from quasistatic_ref.solve.units import DenseStepInBothUnits, in_si
from tests.extras import missing
from tests.helpers import error
from tests.tolerances import ACTIVE_SET

pytestmark = pytest.mark.extra("fast")


@pytest.fixture(scope="module")
def at():
    return places(3)


def test_a_quick_run_writes_every_table_and_does_not_judge(tmp_path, capsys):
    assert main(["bench", "--quick", "--json", "--out", str(tmp_path)]) == 0
    found = json.loads(capsys.readouterr().out)
    assert json.loads((tmp_path / "bench.json").read_text()) == found
    assert set(found["grasp"]) == {"step", "over_solver", "certified", "certified, p99"}
    in_jax = set() if missing("jax") else {MAPPED, "step_jax"}
    assert set(found["derivatives"]) == {STEP, "derivatives"} | in_jax
    of_run = found["run"]
    assert of_run[WALL] > of_run["the stages of its steps"] > 0.0
    text = (tmp_path / "bench.md").read_text()
    for title in ("certificate", "300 steps", "Derivatives", "Scenes of solids"):
        assert title in text
    assert f"| full, plain | {found['certification']['full, plain']:.1f} |" in text
    assert text.count("| not judged |") == len(found["promises"])


def test_the_interfaces_lead_to_the_same_step(at):
    native = at.scenario.simulator()
    for q, goal in zip(at.q, at.goals, strict=True):
        result = native.step(q, goal)
        step = result.step
        delta_q = result.solution.delta_q
        x = bare_daqp(native.solver.program)()[0]
        alone, _ = in_si(x, np.zeros(0), DenseStepInBothUnits(step).units)
        assert error(step, alone, delta_q) <= ACTIVE_SET


def test_of_several_runs_the_least_time_of_each_round_is_kept():
    runs = [{"a": np.array([1.0, 5.0, 3.0])}, {"a": np.array([4.0, 2.0, 3.0])}]
    assert least(iter(runs))["a"].tolist() == [min(1, 4), min(5, 2), min(3, 3)]


def test_times_are_taken_in_turn():
    calls = []
    rounds = [{"a": lambda: calls.append("a"), "b": lambda: calls.append("b")}] * 2
    times = in_turn(rounds, repeat=2)
    assert "".join(calls) == "abab" * 2
    assert times["a"].shape == (2,)
    assert (times["a"] > 0).all()


def test_each_promise_is_judged_by_its_limit():
    grasp = {"step": 89.0, "over_solver": 4.1}
    tables = {"quick": False, "grasp": grasp}
    judged = {p["what"]: p["holds"] for p in promises(tables)}
    assert judged == {
        "step of the grasp over the bare solver": False,
        "step of the grasp [us]": True,
    }
    # Of boxes by MuJoCo's step, unless the solver alone takes more than six of that.
    by_mujoco = {"over_solver": 5.0, "over_mujoco": 5.9, "solver_over_mujoco": 1.2}
    by_solver = {"over_solver": 2.1, "over_mujoco": 13.0, "solver_over_mujoco": 6.2}
    proved = {"proved_over_off": 4.1}
    solids = {
        "few": by_mujoco | proved,
        "many": by_solver | proved,
        "alone": proved | {"over_solver": 5.0},
    }
    judged = promises({"quick": False, "grasp": grasp, "solids": solids})[2:]
    assert {p["what"]: p["holds"] for p in judged} == {
        "few, step over MuJoCo's": True,
        "many, step over the bare solver": False,
        **{f"{name}, proved over not": False for name in solids},
    }
    rows = promise_rows(promises(tables))
    assert rows[1] == ("step of the grasp over the bare solver", "4.1", "at most 4", "FAILS")
