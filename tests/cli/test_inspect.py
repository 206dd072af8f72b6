"""``inspect``: what of a URDF or a scenario is used, and what is ignored."""

import json

import numpy as np
import pytest

from quasistatic_ref.files.clouds import KINDS
from quasistatic_ref.files.mesh_files import MESHES
from quasistatic_ref.files.scenario.other_files import OTHER_FILES
from tests.closeness import assert_within
from tests.extras import SCENARIOS
from tests.files.urdf.urdf_texts import (
    CHAIN,
    collision,
    inertial,
    joint,
    link,
    mimic,
    robot,
    urdf_of_text,
)
from tests.pages import flat
from tests.scenes import RAIL


@pytest.fixture
def inspected(cli):
    """What ``inspect --json`` prints of a file."""
    return lambda *arguments: json.loads(cli("inspect", *arguments, "--json").out)


def test_inspect_shows_a_urdf(tmp_path, cli, inspected):
    path = urdf_of_text(tmp_path, RAIL, "rail.urdf")
    record = inspected(path)
    assert [c["name"] for c in record["coordinates"]] == ["rail/slide", "rail/turn"]
    assert [c["unit"] for c in record["coordinates"]] == ["m", "rad"]
    assert (record["n_a"], record["n_u"]) == (2, 0)
    masses = {link["name"]: link["mass"] for link in record["links"]}
    assert masses == {"rail/rail": 2, "rail/plate": 2, "rail/wheel": 2}
    assert record["links"][1]["shapes"] == [
        {"name": "rail/plate#0", "kind": "Box", "size": "box 0.02 x 0.2 x 0.2 m"}
    ]
    assert "rail: joint limits: position, effort and velocity (2)" in record["ignored"]
    assert record["read_as"] == "a fixed base, all joints actuated"
    text = cli("inspect", path).out
    assert "read with a fixed base, all joints actuated" in text
    assert "rail/slide" in text
    assert "the model ignores:" in text


def test_inspect_does_not_call_ignored_what_the_scenario_uses(tmp_path, inspected):
    rubbed = '<dynamics damping="1" friction="2"/>'
    arm = robot(
        link("a", inertial=""), link("b"), link("c"), link("d"),
        joint("slide", "a", "b", "prismatic", more=rubbed),
        joint("under", "a", "c", "prismatic", more=rubbed + mimic("slide", 2.0)),
        joint("weld", "a", "d", "fixed", more=rubbed),
    )  # fmt: skip
    urdf_of_text(tmp_path, arm, "arm.urdf")
    lines = {}
    for friction in ('"urdf"', "{ slide = 1 }"):
        text = 'format = "quasistatic-ref/scenario"\nversion = 1\nh = 0.01\nsteps = 1\n'
        text += f'[bodies.arm]\nurdf = "arm.urdf"\njoint_friction = {friction}\n'
        path = urdf_of_text(tmp_path, text, "scene.toml")
        lines[friction] = inspected(path)["ignored"]
    assert "arm: joint friction (1)" in lines['"urdf"']  # of the weld
    assert "arm: joint friction (3)" in lines["{ slide = 1 }"]
    assert all("arm: joint damping (3)" in each for each in lines.values())


@pytest.mark.parametrize("kind", ["continuous", "ball"])
def test_bounds_of_a_joint_without_ends_are_ignored_and_named(tmp_path, kind, inspected):
    text = robot(link("a", inertial=""), link("b"), joint("j", "a", "b", kind))
    ignored = inspected(urdf_of_text(tmp_path, text))["ignored"]
    assert "r: bounds of joints that turn without end (1)" in ignored


def test_inspect_says_what_a_mimic_follows(tmp_path, cli, inspected):
    path = urdf_of_text(tmp_path, CHAIN, "arm.urdf")
    assert "\narm/swing_mimic = -0.7 * arm/swing + 0.2\n" in cli("inspect", path).out
    follows = {"name": "arm/swing_mimic", "of": "arm/swing", "multiplier": -0.7, "offset": 0.2}
    assert inspected(path)["mimics"] == [follows]


def test_inspect_shows_a_scenario(scene, cli, inspected):
    record = inspected(scene, "--set", "contacts.floor.mu_omega=0.5")
    stiffness = {c["name"]: c["K_q"] for c in record["coordinates"] if c["actuated"]}
    assert stiffness == {"rail/slide": 500, "rail/turn": 2.5}
    assert "read_as" not in record  # a scenario says how its bodies are held
    assert [pair["mu_omega"] for pair in record["pairs"]] == [0.5, 0.0]
    assert record["size"] == [8, 10]
    text = cli("inspect", scene).out
    assert "each step: 8 variables, 10 rows; h = 0.01 s" in text
    assert "500 N/m" in text
    assert "2.5 N m/rad" in text


def test_inspect_names_each_field_of_a_scenario_as_set_takes_it(scene, cli, inspected):
    fields = inspected(scene)["fields"]
    assert fields["h"] == 0.01
    numbers = {
        name: x for name, x in fields.items() if type(x) in (int, float) and name != "version"
    }
    assert any(name.startswith("contacts.floor.") for name in numbers)
    for name, value in numbers.items():
        cli("inspect", scene, "--json", "--set", f"{name}={value}")
    assert "  h = 0.01\n" in cli("inspect", scene).out


@pytest.mark.parametrize("name", SCENARIOS)
def test_lines_of_inspect_fit_a_terminal(name, cli):
    assert max(map(len, cli("inspect", name).out.splitlines())) <= 120


def test_inspect_names_links_that_nothing_can_touch(tmp_path, cli):
    visual = "<visual><geometry><sphere radius='1'/></geometry></visual>"
    text = robot(link("a", visual), link("b"), joint("j", "a", "b"))
    assert (
        "- one: links with visual but no collision geometry: a\n"
        in cli("inspect", urdf_of_text(tmp_path, text, "one.urdf")).out
    )


TURNED = inertial(
    moments=("0.1", "0.2", "0.25"),
    origin='<origin xyz="0.5 0.25 0.125" rpy="0 0 1.5707963267948966"/>',
)


def test_inspect_shows_inertias_along_the_axes_of_their_link(tmp_path, cli, inspected):
    """A quarter turn about z: ixx along the frame of the inertia is iyy along the link's."""
    path = urdf_of_text(tmp_path, robot(link("a", inertial=TURNED)), "one.urdf")
    (found,) = inspected(path)["links"]
    assert found["centre"] == [0.5, 0.25, 0.125]
    assert_within(np.diag(found["inertia"]), [0.2, 0.1, 0.25])
    out = cli("inspect", path).out
    assert "inertias: about the centre of mass, along the link's axes" in out
    assert "0.5 0.25 0.125" in out


def test_findings_are_listed_before_a_run(cli, inspected):
    scene = "block_push", "--set", "contacts.floor.k=1"
    printed = flat(cli("inspect", *scene).out)
    assert "findings, before a run: - grave: block lies flat" in printed
    (found,) = inspected(*scene)["findings"]
    assert (found["name"], found["grave"]) == ("too-few-points", True)


OTHERS = {
    "m.obj": "a mesh; `quasistatic-ref body FILE` makes a body of it",
    "m.STL": "a mesh; `quasistatic-ref body FILE`",
    "m.dae": "a mesh; `quasistatic-ref body FILE`",
    "c.csv": "a cloud; `quasistatic-ref body FILE`",
    "c.pcd": "a cloud; `quasistatic-ref body FILE`",
    "c.ply": "a mesh or a cloud; `quasistatic-ref body FILE`",
    "run.npz": "a run, of which `extract` takes steps",
    "r.urdf.xacro": "a xacro; `xacro FILE > robot.urdf`",
    "step.json": "JSON; `solve` reads steps",
    "robot.mjcf": "a MuJoCo scene; `run` and `opinion` read it",
    "a.sdf": "an SDF, which nothing here reads",
    "world.world": "an SDF, which nothing here reads",
    "scene.yaml": "YAML; a scenario is TOML",
    "problem.mat": "a quadratic program; `qp`",
    "scene.toml.txt": "a text, as some editors name files that they save; rename it to scene.toml",
    "hand.URDF.txt": "a text, as some editors name files that they save; rename it to hand.URDF",
    "scene.xml.txt": "a text, as some editors name files that they save; rename it to scene.xml",
}


@pytest.mark.parametrize("name", OTHERS)
def test_a_file_of_another_kind_is_called_by_it_with_the_command_that_takes_it(tmp_path, cli, name):
    """Whatever it holds, and however large it is."""
    path = tmp_path / name
    path.write_bytes(b"\x00" * 2**20 * (1 + (name == "m.obj")))
    for command in ("inspect", "run"):
        said = flat(cli(command, path, status=2).err)
        assert f"{path}: is no scenario, but {OTHERS[name]}" in said


def test_every_kind_that_body_reads_is_named():
    assert {*MESHES, *KINDS} <= OTHER_FILES.keys()


def test_a_robot_whose_meshes_are_not_there_is_shown_and_they_are_named(tmp_path, cli, inspected):
    """A mesh that may not be read, or is spoilt, is refused."""
    meshes = [f'<mesh filename="{uri}"/>' for uri in ("model://arm/a.obj", "meshes/b.stl")]
    arm = robot(
        link("stand", "".join(map(collision, meshes))),
        link("arm", collision('<box size="1 1 1"/>')),
        joint("turn", "stand", "arm"),
    )  # fmt: skip
    path = urdf_of_text(tmp_path, arm, "arm.urdf")
    record = inspected(path)
    where = "link[stand].collision[{}].mesh.filename: no such file (looked for in "
    assert [one.startswith(where.format(i)) for i, one in enumerate(record["missing"])] == [
        True
    ] * 2
    assert [c["name"] for c in record["coordinates"]] == ["arm/turn"]
    assert [len(one["shapes"]) for one in record["links"]] == [0, 1]
    assert [one["mass"] for one in record["links"]] == [2, 2]
    said = flat(cli("inspect", path).out)
    assert "meshes that are not there, whose shapes are left out:" in said
    assert "model://arm/a.obj" in said
    urdf_of_text(tmp_path, "solid", "b.stl")
    spoilt = urdf_of_text(tmp_path, arm.replace("meshes/", ""), "arm.urdf")
    assert "mesh: is cut off" in flat(cli("inspect", spoilt, status=2).err)
