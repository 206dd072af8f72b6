"""A state of Drake as a step: that of the same bodies through URDF."""

from importlib import import_module

import numpy as np
import pytest

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ModelError
from quasistatic_ref.lab.claims.engines.drake import set_pose
from quasistatic_ref.lab.scenes.systems import joint_text, link_text, robot_text
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.system import System
from quasistatic_ref.optional.guests.drake import MARGIN, drake_step
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.solve import solve_step

H = 0.01
SMALL = (1e-3, 2e-3, 3e-3)
BALL = '<sphere radius="0.05"/>'
TABLE = '<box size="1 1 0.2"/>'
ROD = '<cylinder radius="0.03" length="0.2"/>'
MESH = '<mesh filename="{folder}/wedge.obj"/>'
WEDGE = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
BASE = link_text("base", 1.0, SMALL)


ROUNDED = 1e-9
"""Of the largest displacement: masses, forces and gaps are rounded twice."""
KEPT = []
"""Diagrams and contexts, which Drake's parts of them do not keep alive."""


def free(name, shape):
    """A robot of one link."""
    return robot_text(link_text(name, 0.3, SMALL, shape, (0.01, 0.0, -0.01)))


def slider(shape, axis="1 0 0"):
    """A link on a rail."""
    link = link_text("tip", 0.2, SMALL, shape)
    return robot_text(BASE, link, joint_text("rail", "prismatic", "base", "tip", axis))


ARM = robot_text(
    BASE,
    link_text("upper", 0.5, SMALL, com=(0.1, 0, 0)),
    link_text("tip", 0.2, SMALL, BALL),
    joint_text("shoulder", "revolute", "base", "upper", "0 1 0"),
    joint_text("elbow", "revolute", "upper", "tip", "0 1 0", "0.2 0 0"),
)
TIP_ON = {"shoulder": 0.3, "elbow": 0.2}
STATES = {
    "a ball on a table": (
        {"table": slider(TABLE), "ball": free("ball", BALL)},
        {"ball": (0.1, 0.05, 0.15), "rail": 0.0},
        {"rail": 500.0},
    ),
    "a rail pushes a ball on a table": (
        {"push": slider(BALL), "ball": free("ball", TABLE)},
        {"ball": (0.551, 0.1, 0.03), "rail": 0.0},
        {"rail": 300.0},
    ),
    "an elbow that is passive": (
        {"arm": ARM, "ball": free("ball", BALL)},
        {"ball": (0.29, 0.0, -0.06), **TIP_ON},
        {"shoulder": 40.0},
    ),
    "a mesh": (
        {"push": slider(BALL), "wedge": free("wedge", MESH)},
        {"wedge": (0.0505, -0.02, -0.02), "rail": 0.0},
        {"rail": 200.0},
    ),
    "a cylinder and a rail that are apart": (
        {"push": slider(BALL, "0 1 0"), "rod": free("rod", ROD)},
        {"rod": (0.01, 0.09, 0.02), "rail": 0.002},
        {"rail": 100.0},
    ),
}  # fmt: skip


def of_drake(texts, places, folder):
    """A plant of some robots and its context; those without a place are welded to the world."""
    module = import_module("pydrake.all")
    builder = module.DiagramBuilder()
    plant, _ = module.AddMultibodyPlantSceneGraph(builder, 0.0)
    for name, text in texts.items():
        path = folder / f"{name}.urdf"
        path.write_text(text.replace(' version="1.1"', ""))
        module.Parser(plant, name).AddModels(str(path))
        if name not in places:
            plant.WeldFrames(plant.world_frame(), plant.GetFrameByName("base"))
    plant.Finalize()
    diagram = builder.Build()
    root = diagram.CreateDefaultContext()
    context = plant.GetMyContextFromRoot(root)
    for name in texts:
        if name in places:
            set_pose(plant, context, plant.GetBodyByName(name), np.eye(3), np.array(places[name]))
    KEPT.append((diagram, root))
    return plant, context


@pytest.mark.extra("drake")
@pytest.mark.parametrize("state", STATES)
def test_a_state_is_the_one_that_its_urdf_gives(state, tmp_path):
    """delta_q and forces."""
    given, places, stiffness = STATES[state]
    (tmp_path / "wedge.obj").write_text(WEDGE)
    texts = {name: text.replace("{folder}", str(tmp_path)) for name, text in given.items()}
    ends = {name: q + 0.004 for name, q in places.items() if name in stiffness}

    bodies = []
    for name, text in texts.items():
        base = {"base": "floating", "xyz": places[name]} if name in places else {}
        own = {j: places[j] for j in ("rail", "shoulder", "elbow") if f'"{j}"' in text}
        acts = [j for j in own if j in stiffness]
        bodies.append(
            Body(name, text, actuated=acts, positions=own, package_dirs=[tmp_path], **base)
        )
    system = System(bodies)
    K = {f"{b.name}/{j}": k for b in bodies for j, k in stiffness.items() if j in b.actuated}
    a, b = system.shapes
    pair = ContactPair("pair", a, b, mu_v=1.0, mu_omega=0.0, rows=4, k=1)
    simulator = Simulator(system, [pair], h=H, K_q=K, gravity_acts=np.ones(system.n_a, bool))
    bar = system.placed({name: ends[name.partition("/")[2]] for name in K})[: system.n_q_a]
    mine = simulator.step(system.q_start, bar).solution

    plant, context = of_drake(texts, places, tmp_path)
    for joint in ("rail", "shoulder", "elbow"):
        if joint in places:
            where = "set_translation" if joint == "rail" else "set_angle"
            getattr(plant.GetJointByName(joint), where)(context, places[joint])
    step, coordinates = drake_step(plant, context, H, stiffness, ends, depth="as is")
    theirs = solve_step(step)
    # Drake's bases move by [omega; v] in the world's axes, ours by [v; omega] in the body's.
    T = np.zeros((plant.num_velocities(), system.n_v))
    for joint in system.joints:
        if joint.free:
            at = plant.GetBodyByName(joint.name.partition("/")[0]).floating_velocities_start_in_v()
            T[at + 3 : at + 6, joint.v.start : joint.v.start + 3] = np.eye(3)
            T[at : at + 3, joint.v.start + 3 : joint.v.stop] = np.eye(3)
        else:
            v = plant.GetJointByName(joint.name.partition("/")[2]).velocity_start()
            T[v, joint.v.start] = 1.0
    here = T @ mine.delta_q
    there = coordinates.T @ theirs.delta_q
    np.testing.assert_allclose(there, here, atol=ROUNDED * np.abs(here).max(), rtol=0)
    assert len(step.contacts.name) == 1
    f_n = mine.wrench[0, 2]
    assert theirs.wrench[0, 2] == pytest.approx(f_n, rel=ROUNDED, abs=ROUNDED)
    assert ("apart" in state) == (f_n == 0)
    assert mine.step.contacts.phi[0] < MARGIN


@pytest.mark.extra("drake")
@pytest.mark.parametrize(
    ("stiffness", "targets", "says"),
    [
        ({"none": 1.0}, {}, "no joint"),
        ({"rail": 0.0}, {}, "greater than 0"),
        ({"rail": 1.0}, {"other": 1.0}, "has no stiffness"),
    ],
)
def test_what_no_step_has_is_refused(stiffness, targets, says, tmp_path):
    """By name."""
    plant, context = of_drake({"push": slider(BALL)}, {}, tmp_path)
    with pytest.raises(ModelError, match=says):
        drake_step(plant, context, H, stiffness, targets)
