"""What a study is called with: what it means, and what is refused before anything is written."""

import threading

import pytest

from quasistatic_ref import InputError
from tests.cases import cases
from tests.lab.study import broken
from tests.lab.study.asked import (
    Limits,
    Setting,
    Solver,
    function_solver,
    plan,
    problems_taken,
    settings_of,
    solvers_of,
    study,
)

MINE = broken.honest
LOCK = threading.Lock()
MISTAKES = {
    "an unknown family": (
        {"problems": {"contact": 1}},
        "is not a family with proved answers",
    ),
    "no problems": ({"problems": {}}, "problems: must be some, of different names"),
    "cones": ({"problems": {"ellipsoid": 2}}, "has cones; studies contain rows only"),
    "an unknown solver": ({"solvers": ["qpsolvers:dapq"]}, "did you mean 'daqp'?"),
    "an unknown door": ({"solvers": ["a:daqp"]}, "solvers: is no solver: write qpsolvers:"),
    "one name for two": ({"solvers": [MINE, MINE]}, "solvers: stands twice; give one of"),
    "what cannot be sent": (
        {"solvers": [lambda *_: LOCK]},
        "<lambda>: cannot be sent to another process",
    ),
    "an unknown setting": ({"settings": ["hihg"]}, "did you mean 'high'?"),
    "a setting that says nothing to a solver": (
        {"settings": ["high"]},
        "settings: hold nothing that function:honest can be set to",
    ),
    "unknown units": ({"units": ["SI"]}, "units: must be one of raw, natural"),
}


@cases("argument, says", MISTAKES)
def test_a_mistake_is_one_sentence_before_anything_is_written(argument, says, tmp_path):
    with pytest.raises(InputError) as refused:
        study(
            **{"problems": {"gaps": 1}, "solvers": [MINE], "folder": tmp_path / "store"} | argument
        )
    assert says in str(refused.value)
    assert "\n" not in str(refused.value)
    assert not (tmp_path / "store").exists()


def test_a_budget_of_no_time_is_refused():
    with pytest.raises(InputError, match=r"^limits.budget: must be greater than 0"):
        Limits(budget=0.0)


def test_the_plan_has_each_measurement_once_a_solver_after_the_other():
    """Problems in one random order of all families, the same for each."""
    problems = problems_taken({"gaps": 4, "friction": 4})
    solvers = solvers_of(["qpsolvers:daqp", "qpsolvers:osqp"])
    measurements = plan(problems, solvers, settings_of(["default"]), ["natural", "raw"])
    assert [one.solver.name for one in measurements] == ["daqp"] * 16 + ["osqp"] * 16
    names = [[one.problem.id for one in measurements[k : k + 16 : 2]] for k in (0, 16)]
    assert names[0] == names[1] != [one.id for one in problems]
    assert len({(m.problem.id, m.solver.name, m.units) for m in measurements}) == 32


def test_options_of_ones_own_replace_ours_and_a_setting_may_be_new():
    tight = Setting("tight", 1e-11)
    mine = Solver("mine", "qpsolvers", "osqp", {"tight": {"eps_abs": 1e-7}})
    assert settings_of(["high", tight])[1] is tight
    assert mine.asked(tight, 1.0) == ({"eps_abs": 1e-7}, 1e-11)
    own = function_solver(MINE, "mine", options={"tight": {"accuracy": 1e-11}})
    assert own.takes(tight)
    assert own.asked(tight, 1.0) == ({"accuracy": 1e-11}, 1e-11)
