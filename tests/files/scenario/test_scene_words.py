"""Scenes that are written in Python in the words of the files."""

import re
import tomllib

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import InputError
from tests.scenes import RAIL


@pytest.mark.parametrize("name", ["bunny_grasp", "door"])
def test_the_tables_of_a_file_are_the_same_scene(monkeypatch, name):
    path = qr.load_scenario(name).path.resolve()
    monkeypatch.chdir(path.parent)
    tables = tomllib.loads(path.read_text())
    runs = [qr.load_scenario(scene, fast=True, steps=1).run() for scene in (tables, path)]
    assert runs[0] == runs[1]


def with_objects():
    hand = qr.Body("hand", RAIL, actuated=["slide"], xyz=(0, 0, 0.05), positions={"slide": -0.2})
    return {
        "h": np.float64(0.02), "steps": 3, "gravity": np.array([0, 0, -9.81]),
        "bodies": {
            "hand": {"body": hand, "K_q": {"slide": 100.0}, "positions": {"slide": -0.1}},
            "ball": qr.Body.of_shape("ball", qr.Sphere(0.05), 0.3, xyz=(0, 0, 0.05)),
        },
        "shapes": {
            "floor": qr.HalfSpace((0, 0, 1), 0.0),
            "wall": {"shape": qr.Box(size=(0.1, 1, 1)), "pose": {"xyz": (0.5, 0, 0)}},
        },
        "contacts": {"floor": {"alpha": ("floor", "wall"), "beta": "ball", "mu_v": 0.5, "rows": 4}},
    }  # fmt: skip


def in_tables():
    objects = with_objects()
    ball = objects["bodies"]["ball"].urdf
    return objects | {
        "h": 0.02, "gravity": [0.0, 0.0, -9.81],
        "bodies": {
            "hand": {
                "urdf": RAIL, "actuated": ["slide"], "pose": {"xyz": [0, 0, 0.05]},
                "K_q": {"slide": 100.0}, "positions": {"slide": -0.1},
            },
            "ball": {"urdf": ball, "base": "floating", "pose": {"xyz": [0, 0, 0.05]}},
        },
        "shapes": {
            "floor": {"halfspace": {"normal": [0, 0, 1]}},
            "wall": {"box": {"size": [0.1, 1, 1]}, "pose": {"xyz": [0.5, 0, 0]}},
        },
    }  # fmt: skip


def test_objects_and_tables_say_the_same():
    scenes = with_objects(), in_tables()
    objects, tables = (qr.load_scenario(scene, fast=True) for scene in scenes)
    assert objects.run() == tables.run()
    assert [pair.name for pair in objects.pairs] == [pair.name for pair in tables.pairs]
    assert objects.system.of(objects.system.q_start, "hand/slide") == -0.1


def test_a_scene_in_python_is_not_changed_by_settings():
    scene = with_objects()
    qr.load_scenario(scene, {"contacts.floor.mu_v": 0.1})
    assert scene["contacts"]["floor"]["mu_v"] == 0.5
    assert "format" not in scene


MISTAKES = {
    r"floor: is a PointCloud that no file": {"shapes": {"floor": qr.PointCloud(np.eye(3))}},
    r"bodies\.arm\.q: is unknown; did you mean 'pos": {"bodies": {"arm": {"urdf": RAIL, "q": {}}}},
    "not well-formed|malformed": {"bodies": {"arm": {"urdf": "<robot"}}},
    r"arm\.body: must be a Body, in the place": {"bodies": {"arm": {"body": "arm.urdf"}}},
    r"beta: has no collision shape; .*known: hand/\*, hand/plate": {
        "contacts": {"floor": {"alpha": "floor", "beta": "hand", "mu_v": 0.5, "rows": 4}}
    },
}


@pytest.mark.parametrize("words", MISTAKES)
def test_mistakes_are_answered_as_in_a_file(words):
    with pytest.raises(InputError, match=words):
        qr.load_scenario(with_objects() | MISTAKES[words])


SOLIDS = (
    qr.HalfSpace((0, 0, 2), 0.1),
    qr.Box((0.05, 0.06, 0.07)),
    qr.Sphere(0.1),
    qr.Cylinder(0.02, 0.1),
    qr.Capsule(0.02, 0.1),
    qr.Cone(0.02, 0.1),
    qr.Ellipsoid((0.01, 0.02, 0.03)),
)


@pytest.mark.parametrize("solid", SOLIDS)
def test_a_solid_is_itself_in_the_words_of_a_table(solid):
    scene = with_objects()
    scene["shapes"]["floor"] = solid
    assert qr.load_scenario(scene).pairs[0].alpha.shape == solid


FINGER = """<link name="{0}"><inertial><mass value="0.1"/>
<inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size="0.01 0.02 0.04"/></geometry></collision></link>
<joint name="{0}_slide" type="prismatic"><parent link="palm"/><child link="{0}"/>
<origin xyz="{1} 0 0"/><axis xyz="{2} 0 0"/>{3}<limit lower="-1" upper="1" effort="9" velocity="1"/>
</joint>"""
LEFT = FINGER.format("left", 0.04, -1, "")
RIGHT = FINGER.format("right", -0.04, 1, '<mimic joint="left_slide"/>')
SHARED = "mimics 'left_slide' and has no coordinate of its own: name 'left_slide', whose spring"


@pytest.mark.parametrize("wrong", [None, "K_q", "targets[0]"])
def test_fingers_that_mimic_share_the_force_of_one_spring(wrong):
    """Its target is 10 mm deep: K_q e = 10 N, of which either finger presses with one half."""
    names = {"K_q": "left_slide", "targets[0]": "left_slide"} | {wrong: "right_slide"}
    gripper = {
        "urdf": f'<robot name="gripper"><link name="palm"/>{LEFT}{RIGHT}</robot>',
        "actuated": ["left_slide"],
        "K_q": {names["K_q"]: 1000.0},
        "targets": [{"t": 0, names["targets[0]"]: 0.01}],
    }
    held = qr.Body.of_shape("held", qr.Box((0.035, 0.02, 0.02)), mass=0.2)
    grip = {"alpha": "gripper/*", "beta": "held", "mu_v": 0.5, "rows": 4, "k": 4}
    scene = {"h": 0.01, "steps": 1, "gravity": [0, 0, 0], "contacts": {"grip": grip}}
    scene |= {"bodies": {"gripper": gripper, "held": held}}
    if wrong is not None:
        with pytest.raises(InputError, match=rf"bodies.gripper.{re.escape(wrong)}.*: {SHARED}"):
            qr.load_scenario(scene)
        return
    forces = qr.load_scenario(scene, fast=True).run().pair_forces().values()
    assert [force[-1, 0] for force in forces] == pytest.approx([-5.0, 5.0])
