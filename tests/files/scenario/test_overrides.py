"""Changes of a scenario: the command line's strings, mappings and keywords say the same."""

from functools import reduce
from pathlib import Path

import numpy as np
import pytest

from quasistatic_ref import ScenarioError, load_scenario
from tests.cases import cases, refusal
from tests.closeness import assert_same
from tests.files.urdf.urdf_texts import urdf_of_text
from tests.scenes import BALL, written_scenario


@pytest.fixture
def path(tmp_path):
    return written_scenario(tmp_path)


def test_strings_mappings_and_keywords_say_the_same(path):
    strings = [
        "steps=3", "h=0.02", "cone=product", "contacts.floor.mu_v=0.25", "gravity=[0, 0, -1.5]",
        "solver.backend=piqp", "bodies.rail.K_q = { slide = 7, turn = 8.5 }", "record=light",
    ]  # fmt: skip
    mapping = {
        "contacts.floor.mu_v": 0.25,
        "solver.backend": "piqp",
        "bodies.rail.K_q": {"slide": 7, "turn": np.float64(8.5)},
        "gravity": np.array([0, 0, -1.5]),
    }
    one = load_scenario(path, strings)
    two = load_scenario(path, mapping, steps=np.int64(3), h=0.02, cone="product", record="light")
    for scenario in (one, two):
        assert (scenario.steps, scenario.h, scenario.cone) == (3, 0.02, "product")
        assert (scenario.backend, scenario.record) == ("piqp", "light")
        assert scenario.pairs[0].mu_v == 0.25
        assert_same(scenario.gravity, [0, 0, -1.5])
        assert_same(scenario.K_q, np.diag([7, 8.5]))


def test_keywords_are_made_last_and_a_table_may_be_given_whole(path):
    scenario = load_scenario(path, {"steps": 3, "solver": {"backend": "osqp"}}, steps=4)
    assert (scenario.steps, scenario.backend) == (4, "osqp")
    assert load_scenario(path, solver={"certify": "off"}).certify == "off"


def test_the_fields_of_solver_are_keywords_by_their_own_words(path):
    scenario = load_scenario(path, backend="osqp", certify="off", accuracy=1e-8)
    assert (scenario.backend, scenario.certify, scenario.accuracy) == ("osqp", "off", 1e-8)
    table = {"backend": "piqp", "certify": "residual"}
    both = load_scenario(path, {"solver.backend": "osqp"}, solver=table, backend="daqp")
    assert (both.backend, both.certify) == ("daqp", "residual")


def test_the_table_and_settings_of_a_user_are_not_changed(path):
    K_q = {"slide": [7.0], "turn": 8.5}
    settings = {"bodies.rail.K_q": K_q}
    load_scenario(path, settings)
    load_scenario(path, settings)
    assert settings == {"bodies.rail.K_q": {"slide": [7.0], "turn": 8.5}}


@pytest.mark.parametrize("kind", [str, Path])
def test_a_path_from_python_is_the_callers_own_and_may_lead_anywhere(path, tmp_path_factory, kind):
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    urdf = urdf_of_text(elsewhere, BALL.replace('"0.3"', '"0.7"'))
    scenario = load_scenario(path, {"bodies.ball.urdf": kind(urdf)})
    assert scenario.system.mass("ball") == 0.7
    within = {"urdf": kind(urdf), "base": "floating", "pose": {"xyz": (0.065, 0, 0.05)}}
    assert load_scenario(path, {"bodies.ball": within}).system.mass("ball") == 0.7


RECURSIVE = {}
RECURSIVE["inner"] = RECURSIVE
DEEP = reduce(lambda inner, _: [inner], range(900), 1.0)

REFUSED = {
    "one string": ("h=1", {}, "settings: must be a list of dotted.key=value, or a mapping"),
    "no changes": (3, {}, "settings: must be a list of dotted.key=value, or a mapping"),
    "a field of that name": (["settings=3"], {}, "--set settings=3: is unknown; known: "),
    "a value that holds itself": ({"h": RECURSIVE}, {}, "h: is nested too deeply, or holds itself"),
    "900 lists in one another": ({"gravity": DEEP}, {}, "gravity: is nested "),
    "a keyword that holds itself": ((), {"solver": RECURSIVE}, "solver: is nested too deeply"),
    "a contact that is not there": (
        ["contacts.flor.mu_v=1"], {},
        "--set contacts.flor.mu_v=1: contacts.flor is no table of the scenario; did you mean "
        "'floor'?",
    ),
    "a contact that is not there, in Python": (
        {"h": 0.01, "contacts.flor.mu_v": 1},
        {},
        "contacts.flor.mu_v: contacts.flor is no table of the scenario; did you mean 'floor'?",
    ),
    "a body that is not there, as a keyword": (
        (),
        {"bodies.bal.mass": 1},
        "bodies.bal.mass: bodies.bal is no table of the scenario; did you mean 'ball'?",
    ),
    "no key": ({"": 3}, {}, "settings: must be table.field=value, such as contacts.floor.mu_v=0.5"),
    "a part of a contact": (
        (),
        {"contacts": {"floor": {"mu_v": 0.2}}},
        'contacts.floor: would replace the whole table; a single field is the setting "contacts.'
        'floor.mu_v" (got',
    ),
    "a base's target as a list": (
        {"bodies.ball.actuated": ["base"], "bodies.ball.K_q": {"base": 100.0}},
        {"bodies.ball.targets": [{"t": 0, "base": [0, 0, 1]}]},
        "bodies.ball.targets[0].base: must be a pose, { xyz = [x, y, z], rpy = [roll, pitch, yaw] }"
        ", in m and rad (got [0, 0, 1])",
    ),
    "an open end": ({"h": 0}, {}, "h: must be greater than 0 (got 0)"),
    "too small": ({"contacts.floor.mu_v": -1}, {}, "contacts.floor.mu_v: must be at least 0"),
    "a float as a count": ({"steps": 1.0}, {}, "steps: must be a whole number"),
    "a number as a truth": ({"fast": 1}, {}, "fast: must be true or false"),
    "no choice": (
        {"bodies.ball.base": "floting"}, {},
        "bodies.ball.base: is not a choice; did you mean 'floating'?",
    ),
    "words as numbers": ({"gravity": ["a"]}, {}, "gravity: must be 3 finite numbers"),
    "a truth as a number": ({"gravity": [True, 0, 0]}, {}, "gravity: must be 3 finite numbers"),
    "four numbers": ({"gravity": [1, 2, 3, 4]}, {}, "gravity: must be 3 numbers"),
    "a list as a table": ({"solver": []}, {}, "solver: must be a table"),
    "a backend of a letter more": (
        (), {"backend": "osqqp"}, "solver.backend: is not a backend; did you mean 'osqp'?",
    ),
    "a certificate of a letter less": (
        (), {"certify": "of"}, "solver.certify: is not a choice; did you mean 'off'?",
    ),
    "no accuracy": ((), {"accuracy": 0}, "solver.accuracy: must be greater than 0 (got 0)"),
    "a backend as a solver": (
        (), {"solver": "osqp"},
        "solver: is the table of backend, certify and accuracy; did you mean 'backend'?",
    ),
    "another word": (
        (), {"tolerance": 1e-9}, "tolerance: is unknown; did you mean 'accuracy' of [solver]?",
    ),
    "unknown keyword": ((), {"step": 3}, "step: is unknown; did you mean 'steps'"),
    "a function": ({"h": abs}, {}, "h: must be a number"),
}  # fmt: skip


@cases("settings, named, says", REFUSED)
def test_changes_that_cannot_be_made_are_one_sentence(path, settings, named, says):
    file = f"{path}: " if says.startswith("settings") else ""
    with refusal(ScenarioError, f"{file}{says}"):
        load_scenario(path, settings, **named)


def test_a_mistake_of_the_file_is_said_of_the_file_whatever_else_is_changed(path):
    path.write_text(path.read_text().replace("mu_v", "mu_w", 1))
    with refusal(ScenarioError, f"{path}: contacts."):
        load_scenario(path, ["h=0.02", "contacts.floor.k=3"], steps=3)


def test_a_contact_may_be_made_of_changes_alone(path):
    contact = {"alpha": "floor", "beta": "rail/plate", "mu_v": 0.5, "rows": 4}
    changes = {f"contacts.flor.{name}": value for name, value in contact.items()}
    assert len(load_scenario(path, changes).pairs) == 3
