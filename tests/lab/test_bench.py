"""The benchmark runs, judges by its limits, and compares what gives the same answers."""

import json

import numpy as np
import pytest

from quasistatic_ref.lab.bench.acceptance import promises
from quasistatic_ref.lab.bench.derived import MAPPED, STEP
from quasistatic_ref.lab.bench.grasp import bare_daqp, places
from quasistatic_ref.lab.bench.report import promise_rows
from quasistatic_ref.lab.bench.scenes import GRAVITY, HAND, MU_V, H, cubes
from quasistatic_ref.lab.bench.solids import LARGE, STATES
from quasistatic_ref.lab.bench.timing import in_turn, least
from quasistatic_ref.lab.bench.whole_run import WALL
from quasistatic_ref.solve.units import DenseStepInBothUnits, in_si
from tests.extras import is_missing
from tests.helpers import error
from tests.tolerances import ACTIVE_SET, SCENE

pytestmark = pytest.mark.extra("fast")


@pytest.fixture(scope="module")
def at():
    return places(3)


def test_a_quick_run_writes_every_table_and_does_not_judge(tmp_path, cli):
    found = json.loads(cli("bench", "--quick", "--json", "--out", tmp_path).out)
    assert json.loads((tmp_path / "bench.json").read_text()) == found
    assert set(found["grasp"]) == {"step", "over_solver", "certified", "certified, p99"}
    in_jax = set() if is_missing("jax") else {MAPPED, "step_jax"}
    assert set(found["derivatives"]) == {STEP, "derivatives"} | in_jax
    of_run = found["run"]
    assert of_run[WALL] > of_run["the stages of its steps"] > 0.0
    text = (tmp_path / "bench.md").read_text()
    for title in ("certificate", "300 steps", "Derivatives", "Scenes of solids", "Many bodies"):
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
    # Of single cubes by MuJoCo's step, unless the solver alone takes more than six of that.
    few, many, alone = [*STATES][:3]
    own = {"full": 10.0, "proved_over_off": 4.1, "first_over_later": 9.9}
    by_mujoco = own | {"over_solver": 5.0, "over_mujoco": 5.9, "solver_over_mujoco": 1.2}
    by_solver = own | {"over_solver": 2.1, "over_mujoco": 13.0, "solver_over_mujoco": 6.2}
    solids = {few: by_mujoco, many: by_solver, alone: own | {"over_solver": 5.0}}
    solids[HAND] = own | {"proved_over_off": 4.0, "first_over_later": 10.0}
    large = {"10 cubes, askew": own | {"full": 10 / 4.6, "proved_over_off": 5}}
    large["40 cubes, askew"] = own
    judged = promises({"quick": False, "grasp": grasp, "solids": solids, "large": large})[2:]
    assert [(p["what"], p["measured"], p["holds"]) for p in judged] == [
        ("proved step over one that is not, most of 6 scenes, 5 beyond: 10 cubes, askew", 5, False),
        (f"first step over later ones, most of 6 scenes, 0 beyond: {HAND}", 10.0, True),
        (f"step of single cubes over MuJoCo's, most of 1 scenes, 0 beyond: {few}", 5.9, True),
        (
            f"step of single cubes over the bare solver, most of 1 scenes, 1 beyond: {many}",
            2.1,
            False,
        ),
        ("40 cubes, askew over 10 cubes, askew", pytest.approx(4.6), False),
    ]
    rows = promise_rows(promises(tables))
    assert rows[1] == ("step of the grasp over the bare solver", "4.1", "at most 4", "FAILS")


@pytest.mark.parametrize("name", ["8 stacks of five, rest", "24 boxes in a bin"])
def test_bodies_of_a_scene_at_rest_stay_where_they_are(name):
    """And MuJoCo's, where it is installed, stand at the same places."""
    scene = LARGE[name]()
    result = scene.simulator("off", True).step(scene.q, scene.goals[0], scene.force)
    assert np.abs(result.solution.delta_q).max() <= SCENE
    if not is_missing("engines"):
        _, data = scene.model()
        assert np.array_equal(data.qpos.reshape(-1, 7)[:, :3], scene.q.reshape(-1, 7)[:, :3])


def test_pushed_cubes_stick_or_slide_as_their_state_says():
    """Friction holds half of the weight m g: a push of 0.2 m g moves nothing.

    One of 0.7 m g leaves 0.2 m g. The first step of a slide rises, too, by mu_v times its length,
    so that it is h^2 times 0.2 g over 1 + mu_v^2.
    """
    slide = (0.7 - MU_V) * GRAVITY * H**2 / (1 + MU_V**2)
    for push, along in (("rest", 0.0), ("sticks", 0.0), ("slides", slide)):
        scene = cubes(1, 1, 6, push)
        moved = scene.simulator("full", True).step(scene.q, scene.goals[0], scene.force)
        assert moved.solution.delta_q[0] == pytest.approx(along, rel=1e-9, abs=1e-15)
