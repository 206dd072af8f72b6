"""The JSON Schema and the reference page of scenarios say what the loader does."""

import json
import re
import tomllib

import numpy as np
import pytest
from jsonschema import Draft4Validator

from docs.fields_page import reference_page
from quasistatic_ref import Extra, InputError, load_scenario, save_step, solve_step
from quasistatic_ref.files.resources import scenario_path
from quasistatic_ref.files.scenario.scenario_table import TABLES
from quasistatic_ref.files.scenario.world_solids import SOLIDS
from quasistatic_ref.files.trajectory import header_table
from quasistatic_ref.lab.commands.schema import SCHEMAS, scenario_schema
from quasistatic_ref.text.json_text import plain
from tests.cases import cases
from tests.closeness import assert_close
from tests.errors.scene import SCENE, changed, scene_written
from tests.extras import SCENARIOS
from tests.helpers import random_step
from tests.made import infeasible_text, solution_text, step_record
from tests.oracles.records import toml_text

RICH = changed(
    SCENE,
    ("bodies/ball/package_dirs", []), ("bodies/ball/cloud", "cloud.xyz"),
    ("bodies/rail/gravity_compensated", True), ("bodies/rail/K_q", [[500.0]]),
    ("contacts/floor/hull", False),
    ("shapes/mesh", {"mesh": {"file": "cloud.xyz", "scale": [1.0, -1.0, 1.0]}}),
)  # fmt: skip
"""Every kind of table and nearly every field; it is good but for its mesh, which is no mesh."""


@pytest.fixture(scope="module")
def validator():
    schema = scenario_schema()
    Draft4Validator.check_schema(schema)
    return Draft4Validator(schema)


@pytest.mark.parametrize("scene", [*SCENARIOS, SCENE, RICH])
def test_every_scenario_that_comes_along_and_others_are_valid(validator, scene):
    there = isinstance(scene, str)
    text = scenario_path(scene).read_text() if there else toml_text(scene).decode()
    assert [error.message for error in validator.iter_errors(tomllib.loads(text))] == []


def test_every_field_is_in_the_schema_and_on_the_page():
    schema = scenario_schema()
    page = reference_page(TABLES)
    parts = [schema, *schema["definitions"].values()]
    assert len(parts) == len(TABLES)
    for fields, part in zip(TABLES.values(), parts, strict=True):
        assert set(part["properties"]) == set(fields)
        for name, one in fields.items():
            says = re.sub(r"<(?=[a-z])", "&lt;", one.says)  # Markdown would take it for HTML
            assert any(
                line.startswith(f"| `{name}` |") and line.endswith(f"| {says} |")
                for line in page.splitlines()
            )
    assert set(SOLIDS) <= set(TABLES)


FLOOR = "contacts/floor"
RAIL = "bodies/rail"
MISTAKES = {
    # name: a change of a good scene that makes it bad
    "a later version": ("version", 2),
    "no h": ("h", ...),
    "gravity flat": ("gravity", [0.0, -9.81]),
    "an unknown cone": ("cone", "piramid"),
    "no body": ("bodies", {}),
    "two solids in one": ("shapes/wall/sphere", {"radius": 1.0}),
    "a box of no size": ("shapes/wall/box/size", [1.0, 0.0, 1.0]),
    "five rows": (f"{FLOOR}/rows", 5),
    "k zero": (f"{FLOOR}/k", 0),
}  # fmt: skip


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_refused_by_the_loader_and_by_the_schema(validator, tmp_path, name):
    bad = changed(SCENE, MISTAKES[name])
    with pytest.raises(InputError):
        load_scenario(scene_written(tmp_path, bad))
    assert not validator.is_valid(tomllib.loads(toml_text(bad).decode()))


def test_the_defaults_that_the_table_states_are_those_of_the_loader(tmp_path):
    """Written out, they make the scenario that is loaded without them."""
    where = {
        "cone": ("the top of the file", "cone"), "record": ("the top of the file", "record"),
        "solver/accuracy": ("[solver]", "accuracy"), "solver/certify": ("[solver]", "certify"),
        "limits/reach": ("[limits]", "reach"), "contacts/push/k": ("[contacts.NAME]", "k"),
        "limits/penetration": ("[limits]", "penetration"),
        f"{RAIL}/gravity_compensated": ("[bodies.NAME]", "gravity_compensated"),
        f"{RAIL}/base": ("[bodies.NAME]", "base"), f"{FLOOR}/hull": ("[contacts.NAME]", "hull"),
        f"{RAIL}/pose": ("[bodies.NAME]", "pose"), "shapes/floor/halfspace/offset":
        ("halfspace", "offset"), f"{FLOOR}/rows": ("[contacts.NAME]", "rows"),
    }  # fmt: skip
    bare = changed(SCENE, ("solver", {}), ("limits", {}))
    for path in (f"{FLOOR}/rows", "shapes/floor/halfspace/offset"):
        bare = changed(bare, (path, ...))
    plain = load_scenario(scene_written(tmp_path, bare))
    stated = [(path, TABLES[kind][name].default) for path, (kind, name) in where.items()]
    assert load_scenario(scene_written(tmp_path, changed(bare, *stated))) == plain


@pytest.mark.parametrize("kind", ["scenario", "step", "solution", "header"])
def test_the_command_prints_the_schema(cli, kind):
    assert json.loads(cli("schema", kind).out) == json.loads(json.dumps(SCHEMAS[kind]()))
    assert json.loads(cli("schema").out) == json.loads(json.dumps(scenario_schema()))


STEP = random_step(7, n_a=2, n_u=3, rows=(6, 4))
LIMITED = STEP.replace(extra=Extra(("a", "b"), np.eye(2, 5), [-1.0, -1.0], H=np.eye(5)))
RUN = load_scenario("sphere_spin", steps=2).run(progress=False)
FILES = {
    "a step": ("step", step_record(STEP)),
    "a step with rows and a cost": ("step", step_record(LIMITED)),
    "a step in the ellipsoid": ("step", step_record(STEP.replace(cone="ellipsoid"))),
    "a solution": ("solution", json.loads(solution_text(solve_step(STEP)))),
    "a solution with rows": ("solution", json.loads(solution_text(solve_step(LIMITED)))),
    "an infeasible step": ("solution", json.loads(infeasible_text(STEP, ["1/3"] * 10))),
    "a header": ("header", header_table(RUN.header)),
}

MAY_BE_LEFT_OUT = {
    "step": {"cone", "extra"},
    "solution": set(),
    "header": {"units", "positions", "slots", "findings", "scene_sha256"},
}


@cases("kind, record", FILES)
def test_the_schema_of_a_file_takes_what_is_written_and_no_other_field(kind, record):
    Draft4Validator.check_schema(SCHEMAS[kind]())
    checked = Draft4Validator(SCHEMAS[kind]())
    record = plain(record)
    assert [error.message for error in checked.iter_errors(record)] == []
    for wrong in (record | {"backends": 1}, record | {"version": 9}, record | {"cone": 1}):
        assert not checked.is_valid(wrong)
    for name in record:
        less = {key: value for key, value in record.items() if key != name}
        assert checked.is_valid(less) == (name in MAY_BE_LEFT_OUT[kind])


def test_a_contact_s_J_in_a_step_file_is_what_the_schema_says(tmp_path):
    """On an incline, where the world's axes are none of the frame's: by turning and moving it.

    For a small motion J delta_q is how beta's point moves along x, y and z; its spin is the turn
    about n. Alpha, the incline, does not move.
    """
    says = SCHEMAS["step"]()["definitions"]["contacts"]["properties"]["J"]["description"]
    assert re.match("motion of beta's .* along the world's x, y and z, and spin about n", says)
    scenario = load_scenario("block_incline", steps=1)
    result = scenario.simulator().step(scenario.system.q_start)
    written = json.loads(save_step(tmp_path / "step.json", result.step).read_text("utf-8"))
    here, small = scenario.system.at(result.q_start), 1e-6
    links = [pair.beta.link for pair in scenario.pairs for _ in range(pair.n_c)]
    of_contacts = zip(written["contacts"], result.points.beta, links, strict=True)
    for contact, point, link in of_contacts:
        J, n = np.array(contact["J"]), np.array(contact["n"])
        for k, one in enumerate(np.eye(J.shape[1])):
            end = here.plus(small * one).kinematics
            R = end.R[link] @ here.kinematics.R[link].T
            moved = end.t[link] + R @ (point - here.kinematics.t[link]) - point
            turned = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / 2
            assert_close(J[:3, k], moved / small, 1e-6)
            assert_close(J[3, k], n @ turned / small, 1e-6)
