"""MuJoCo scenes as others write them: cones, meshes, mocap bodies, sizes, and sentences on them."""

import mujoco
import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import InputError, ModelError
from quasistatic_ref.solve.step_problem import is_large
from tests.optional.mujoco.models import mjcf, model_of, posed

BOX = '<geom {}type="box" size="0.05 0.05 0.05" mass="1"{}/>'
FREE = '<body name="box" pos="{}"><freejoint/>{}</body>'


def scene(bodies, rest="", option="", **fields):
    return qr.mujoco_scenario(model_of(mjcf(bodies, rest, option)), **fields)


WELD = '<equality><weld body1="box"/></equality>'
ELLIPTIC = '<option cone="elliptic"/>'
FLOOR = '<geom name="floor" type="plane" size="1 1 1"/>'
LYING = FREE.format("0 0 0.05", BOX.format("", ""))
ON_FLOOR = FLOOR + LYING


def test_equalities_in_the_elliptic_cone_take_the_pyramid_with_a_note():
    made = scene(ON_FLOOR, WELD, ELLIPTIC, steps=2)
    assert made.cone == "pyramid"
    (note,) = made.system.notes
    assert note.startswith('option.cone: elliptic; "pyramid" is taken, since equality[0] is')
    assert made.run().steps == 2
    with pytest.raises(ModelError, match=r"equality\[0\]: is two rows"):
        scene(ON_FLOOR, WELD, ELLIPTIC, cone="ellipsoid")
    assert not scene(ON_FLOOR, "", ELLIPTIC).system.notes


TWO_GROUPS = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng a\nf 1 2 3\ng b\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
STRAY = TWO_GROUPS + "v 0.9 0.9 0.9\n"
INWARD = "v -1 -1 -1\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 2 1 3\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"


@pytest.mark.parametrize("obj", [TWO_GROUPS, STRAY, INWARD], ids=["groups", "stray", "inward"])
def test_a_mesh_has_the_hull_of_all_its_vertices_as_mujoco_has_it(tmp_path, obj):
    (tmp_path / "m.obj").write_text(obj)
    file = tmp_path / "m.xml"
    mesh = '<asset><mesh name="m" file="m.obj" scale="0.1 0.1 0.1" inertia="convex"/></asset>'
    body = FREE.format("0 0 0.2", '<geom type="mesh" mesh="m"/>')
    file.write_text(mjcf(FLOOR + body, mesh))
    model = mujoco.MjModel.from_xml_path(str(file))
    (hull,) = [
        placed.shape
        for placed in qr.mujoco_scenario(model).drive.system.places.shapes.values()
        if placed.link
    ]
    graph = model.mesh_graph[model.mesh_graphadr[0] :]
    corners = model.mesh_vert[graph[2 + graph[0] : 2 + 2 * graph[0]]]
    assert len(hull.vertices) == len(corners)
    for vertex in hull.vertices:
        assert np.abs(corners - vertex).max(axis=1).min() < 1e-7


@pytest.mark.parametrize("up", ["0 0 0", "0 0 0.05"])
def test_keyframes_that_move_a_mocap_body_are_refused_by_name(up):
    table = '<body name="table" mocap="true"><geom type="box" size="1 1 0.1"/></body>'
    slide = '<body pos="3 0 0"><joint name="a" type="slide"/><geom size="0.1"/></body>'
    rest = '<actuator><position joint="a"/></actuator><keyframe><key name="down" ctrl="0"/>'
    rest += f'<key name="up" ctrl="0.1" mpos="{up}"/></keyframe>'
    if up == "0 0 0":
        assert scene(table + slide, rest, targets=["down", "up"]).steps
        return
    with pytest.raises(InputError, match="keyframe up: moves bodies with mocap away from where"):
        scene(table + slide, rest, targets=["down", "up"])


@pytest.mark.usefixtures("compiled_here")
def test_a_built_in_mesh_whose_parameters_are_large_numbers_runs(tmp_path, cli):
    geom = '<geom type="mesh" mesh="w" mass="0" contype="0" conaffinity="0"/>'
    file = tmp_path / "m.xml"
    body = FREE.format("0 0 0.05", BOX.format("", "") + geom)
    asset = '<asset><mesh name="w" builtin="wedge" params="37 37 45 45 0"/></asset>'
    file.write_text(mjcf(FLOOR + body, asset))
    printed = cli("run", file, "--set steps=2 --out", tmp_path).out
    assert "2 of 2 steps exact" in printed


def many(count, memory="50M"):
    """Two bodies of boxes, as bowls are made of."""
    side = range(count)
    boxes = "".join(f'<geom type="box" size=".01 .01 .01" pos="{0.03 * i} 0 0"/>' for i in side)
    bodies = "".join(
        f'<body name="{name}" pos="0 0 {z}"><freejoint/>{boxes}</body>'
        for name, z in (("bowl", 0.1), ("lid", 0.2))
    )
    return bodies, "", f'<size memory="{memory}"/>'


def test_places_are_counted_before_they_are_made_and_the_refusal_says_what_to_exclude():
    assert scene(*many(20), steps=1).drive.system.places.counts.sum() == 20 * 20 * 8
    with pytest.raises(ModelError) as refused:
        scene(*many(60))
    sentence = str(refused.value)
    assert sentence.startswith(
        "geoms that may touch: are 3600 pairs with 28800 places for contacts"
    )
    assert "28800 of them are of bowl and lid: exclude them (contact/exclude" in sentence


def test_pairs_that_mujoco_has_no_memory_for_are_not_left_out_in_silence():
    with pytest.raises(ModelError, match=r"geoms that may touch: are 200, and make more pairs"):
        scene(*many(100, "1M"))


def test_a_step_of_many_coordinates_is_solved_without_the_map_of_its_parameters():
    boxes = "".join(
        FREE.format(f"{0.3 * i} 0 0.0499", BOX.format("", "")).replace(
            'name="box"', f'name="box{i}"'
        )
        for i in range(48)
    )
    step, _ = qr.mujoco_step(*posed(mjcf(FLOOR + boxes)), 0.01)
    assert is_large(qr.StepProblem(step).problem)
    answer = qr.solve_step(step)
    assert answer.certificate.kind == "exact"
    assert answer.forces[:, 2].sum() == pytest.approx(48 * 9.81)


@pytest.mark.parametrize("between", [False, True])
def test_a_body_without_a_joint_that_overlaps_its_children_is_named(between):
    """A torso as files have it whose root joint a program adds; without, the leg cannot go out."""
    hinge = '<joint type="hinge" axis="0 1 0" limited="true" range="-0.1 0.1"/>'
    ball = '<geom size="0.1" mass="1" pos="0.05 0 0"/>'  # 158.1 mm from the torso's of 100 mm
    leg = f'<body name="leg" pos="0 0 -0.15">{hinge}{ball}</body>'
    leg = f'<body name="hip">{leg}</body>' if between else leg
    torso = '<body name="torso" pos="0 0 1">{}<geom size="0.1" mass="1"/>{}</body>'
    words = r"no solution: .*; body\[torso\] has no joint.*overlaps body\[leg\] by up to 41.9 mm"
    with pytest.raises(qr.RunFailed, match=words):
        scene(torso.format("", leg), steps=1).run()
    free = scene(torso.format("<freejoint/>", leg), steps=1)
    assert free.system.notes == ()
    if not between:  # MuJoCo leaves out parents and children, of what is not part of the world
        free.run()
