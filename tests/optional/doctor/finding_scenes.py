"""Short runs, each with a finding: a cell a scene, which test_findings.py runs.

Scenes without a finding are in healthy_scenes.py, which is built with the words of this file. In a
cell `after` has runs with a remedy applied, by the words of the remedy.
"""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from mujoco import MjModel
from quasistatic_ref import (
    FastSimulator,
    Body,
    Box,
    Capsule,
    ContactPair,
    Cylinder,
    HalfSpace,
    PlacedShape,
    PointCloud,
    RunFailed,
    Simulator,
    Sphere,
    System,
    convex_hull,
    mujoco_scenario,
    rollout,
)


def joint(kind, axis, size=(0.1, 0.1, 0.1), mass=2.0, inertia=0.02):
    """URDF of a box on a joint, without a motor unless a Body names `joint` as actuated."""
    return (
        f'<robot name="r" version="1.1"><link name="base"/><link name="part"><inertial><mass value="{mass}"/>'
        f'<inertia ixx="{inertia}" iyy="{inertia}" izz="{inertia}" ixy="0" ixz="0" iyz="0"/></inertial>'
        f'<collision><geometry><box size="{size[0]} {size[1]} {size[2]}"/></geometry></collision></link>'
        f'<joint name="joint" type="{kind}"><parent link="base"/><child link="part"/><axis xyz="{axis}"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>'
    )


def of_mujoco(option, actuator):
    """What is found of a slide in MuJoCo whose actuator has targets of 0 to 1."""
    slide = '<body><joint name="j" type="slide" axis="1 0 0"/><geom size="0.1"/></body>'
    text = f"<mujoco>{option}<worldbody>{slide}</worldbody><actuator>{actuator}</actuator></mujoco>"
    with TemporaryDirectory() as folder:
        table = Path(folder) / "targets.csv"
        table.write_text("t,0\n0,0\n0.02,1\n")
        scene = mujoco_scenario(MjModel.from_xml_string(text), targets=table, steps=3)
        return scene.run(progress=False).findings


def box(size=(0.1, 0.1, 0.1), mass=1.0, name="box", **where):
    """A free box; it stands on the floor unless `xyz` says otherwise."""
    return Body.of_shape(name, Box(size=size), mass, **({"xyz": (0, 0, size[2] / 2)} | where))


def ball(radius=0.05, mass=0.3, xyz=(0, 0, 0.05)):
    """A free ball; it stands on the floor unless `radius` or `xyz` says otherwise."""
    return Body.of_shape("ball", Sphere(radius), mass, xyz=xyz)


def motor(name, axis="1 0 0", size=(0.1, 0.1, 0.1), **where):
    """A box on a slide with a motor."""
    return Body(name, joint("prismatic", axis, size), actuated="all", **where)


def fingers(x, z, size=(0.1, 0.1, 0.1)):
    """Two motors that close along x on what is between them."""
    return [
        motor("left", "1 0 0", size, xyz=(-x, 0, z)),
        motor("right", "-1 0 0", size, xyz=(x, 0, z)),
    ]


def walls(y):
    """Two walls, 0.1 m thick, whose middles are so far from y = 0."""
    return [(f"wall{side:+}", Box(size=(2, 0.1, 2)), (0, side * y, 0)) for side in (-1, 1)]


def lies(body="box", mu_v=0.5, k=4):
    """The contacts of a body on the floor."""
    return [("floor", body, mu_v, k)]


STANDS = lies()
IN_SLOT = [*STANDS, ("wall-1", "box", 0.5, 4), ("wall+1", "box", 0.5, 4)]
TIP = (0.02, 0.02, 0.02)
"""Of a finger [m]."""
FACE = [(x, y, -0.05) for x in np.linspace(-0.05, 0.05, 10) for y in np.linspace(-0.05, 0.05, 10)]
"""A hundred points on the lower face of a box."""
weak = joint("prismatic", "0 0 1").replace('effort="1"', 'effort="2"')
TIN = Body.of_shape("tin", Cylinder(0.04, 0.05), 0.4, xyz=(0, 0, 0.05))
DRAWER = Body("drawer", joint("prismatic", "1 0 0"))
RAIL = ("rail", Box(size=(2, 0.04, 0.04)), (0, 0, -0.07))


def findings(
    bodies,
    contacts=STANDS,
    stands=(),
    cloud=None,
    push=None,
    target=None,
    steps=3,
    mu_omega=0.0,
    K_q=500.0,
    h=0.01,
    seconds=None,
    **more,
):
    """What is found in a short run of `contacts`: (alpha, beta, mu_v, k)."""
    system = System(bodies)
    shapes = {"floor": [PlacedShape.in_world("floor", HalfSpace((0, 0, 1.0), 0.0))]}
    for name, shape, *where in stands:
        shapes[name] = [PlacedShape.in_world(name, shape, *where)]
    for body in bodies:
        shapes[body.name] = [
            s for s in system.shapes if system.links[s.link].startswith(f"{body.name}/")
        ]
    for name, points in (cloud or {}).items():
        shapes[name] = [
            PlacedShape(
                name, system.link(name), np.eye(3), np.zeros(3), PointCloud(np.array(points))
            )
        ]
    rows = 6 if mu_omega else 4
    pairs = [
        ContactPair(f"{a}_{b}({x.name}, {y.name})", x, y, mu_v, mu_omega, rows, k)
        for a, b, mu_v, k in contacts
        for x in shapes[a]
        for y in shapes[b]
    ]
    simulator = FastSimulator(Simulator(system, pairs, h=h, K_q=K_q * np.eye(system.n_a), **more))
    force = (
        None
        if push is None
        else lambda t, q: sum(system.load(q, name, f) for name, f in push.items())
    )
    target = system.q_start[: system.n_q_a] if target is None else np.array(target)
    try:
        run = rollout(simulator, system.q_start, target, steps, force=force, progress=False)
    except RunFailed as error:
        run = error.trajectory
    if seconds is not None:
        run = replace(run, seconds={part: np.array([time]) for part, time in seconds.items()})
    return run.findings


TABLE = Box(size=(0.5, 0.4, 0.05))


def over_a_joint(*right, steps=200):
    """What is found of a crate that 1 N pushes from one table to another, without friction."""
    return findings(
        [box(xyz=(-0.06, 0, 0.05))],
        [("left", "box", 0.0, 4), ("right", "box", 0.0, 4)],
        [("left", TABLE, (-0.25, 0, -0.025)), ("right", *right)],
        push={"box": (1, 0, 0)},
        steps=steps,
    )


# %% unsupported-body: two boxes touch each other and nothing else
found = findings([box(), box(name="top", xyz=(0, 0, 0.15))], [("box", "top", 0.5, 4)])
stack = [*STANDS, ("box", "top", 0.5, 4)]
remedy = "add a table [contacts.NAME] of box and what should bear it"
after = {remedy: findings([box(), box(name="top", xyz=(0, 0, 0.15))], stack)}


# %% initial-penetration: the origin of a box is its middle, and it was set on the floor
found = findings([box(xyz=(0, 0, 0.04))])
after = {"start floor and box/solid#0 10 mm farther apart": findings([box(xyz=(0, 0, 0.05))])}


# %% initial-penetration: a box in a gap narrower than itself, where no step has a solution
found = findings([box()], [("wall-1", "box", 0.5, 4), ("wall+1", "box", 0.5, 4)], walls(0.09))

# %% guided-friction: a door on its hinge that grazes the floor
door = Body("door", joint("revolute", "0 0 1"), xyz=(0, 0, 0.05))
found = findings([door], lies("door", mu_v=0.3))
remedy = "leave out contacts.floor_door, and say joint_friction in [bodies.door]"
after = {remedy: findings([door], [])}


# %% guided-friction: a turntable with friction under it
table = Body("table", joint("continuous", "0 0 1"), xyz=(0, 0, 0.05))
found = findings([table], lies("table", mu_v=0.3, k=1), mu_omega=0.02)

# %% guided-friction: a slot as wide as its block
found = findings([box()], IN_SLOT, walls(0.1), push={"box": (50, 0, 0)})

# %% guided-friction: a rod in a shaft with three walls, no two of which are opposite
rod = Body.of_shape("rod", Sphere(0.05), 0.3, xyz=(0, 0, 0))
walls = [
    (f"wall{i}", HalfSpace((np.cos(a), np.sin(a), 0.0), -0.05), (0, 0, 0))
    for i, a in enumerate((0.0, 2.0, 4.0))
]
found = findings([rod], [(f"wall{i}", "rod", 0.5, 1) for i in range(3)], walls)

# %% guided-friction, locked-guide: a planar base cannot rise, under 165 N
found = findings([box(base="planar")], push={"box": (165, 0, 0)})

# %% guided-friction, locked-guide: a drawer on its joint also touches a rail, under 87 N
found = findings([DRAWER], [("rail", "drawer", 0.2, 4)], [RAIL], gravity=(43.5, 0, -9.81))

# %% guided-friction, locked-guide: a slot with a clearance of 0.1 mm, under 100 N
found = findings([box()], IN_SLOT, walls(0.1001), push={"box": (100, 0, 0)}, steps=5)
(locked,) = (x for x in found if x.name == "locked-guide")
assert "box/base.x moves by 0.2 mm under 100 N" in locked.cause
remedy = "give contacts.wall+1_box or contacts.wall-1_box mu_v = 0, or more clearance"
wide = findings([box()], IN_SLOT, walls(0.11), push={"box": (100, 0, 0)}, steps=5)
after = {remedy: wide}


# %% locked-guide: a finger that pushes a drawer which touches its rail
finger = motor("finger", size=TIP, xyz=(-0.06, 0, 0))
found = findings(
    [DRAWER, finger],
    [("rail", "drawer", 0.2, 4), ("finger", "drawer", 0.0, 1)],
    [RAIL],
    target=[0.05],
)

# %% too-few-points: five of the hundred points below a cloud
found = findings([box()], lies(k=5), cloud={"box": FACE})
after = {
    "raise k of contacts.floor_box to 100": findings([box()], lies(k=100), cloud={"box": FACE})
}


# %% too-few-points: a cylinder on its end
found = findings([TIN], lies("tin", k=2))
after = {"raise k of contacts.floor_tin to 4": findings([TIN], lies("tin", k=4))}


# %% too-few-points: the table is named on which it lies, not the wall beside it, which comes first
wall = ("wall", Box(size=(0.1, 0.1, 0.1)), (0.15, 0, 0.05))
found = findings([box()], [("wall", "box", 0.5, 1), ("floor", "box", 0.5, 3)], [wall])
assert [x.remedy for x in found] == ["raise k of contacts.floor_box to 4"]

# %% flush-shapes: a crate stops at the next table, which bears 1 N along and 1 N up
found = over_a_joint(TABLE, (0.25, 0, -0.025))
(joint_of_two,) = (x for x in found if x.name == "flush-shapes")
assert joint_of_two.numbers["along_N"] == pytest.approx(1.0)
assert joint_of_two.remedy == "make left and right one shape, or set right 10 um lower"
after = {joint_of_two.remedy: over_a_joint(TABLE, (0.25, 0, -0.02501))}


# %% flush-shapes: before a run
found = over_a_joint(TABLE, (0.25, 0, -0.025), steps=0)

# %% flush-shapes: the next table is a mesh
corners = [(x, y, z) for x in (0, 0.5) for y in (-0.3, 0.2) for z in (-0.05, 0)]
found = over_a_joint(convex_hull(corners))

# %% flush-shapes: the next table is turned by a quarter of a turn
turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
found = over_a_joint(TABLE, (0.2, 0, -0.025), turn)

# %% stray-points: two of them, side by side
found = findings([box()], cloud={"box": [*FACE, (0.3, 0, 0.1), (0.3, 0, 0.1001)]})
remedy = "leave them out, or make the cloud by quasistatic-ref body"
after = {remedy: findings([box()], cloud={"box": FACE})}


# %% inertia: 1e-9, so that the solver has something
crate = Body("crate", joint("revolute", "0 0 1", inertia=1e-9))
found = findings([crate], [])

# %% sizes-apart: a table in millimetres under a box in metres
found = findings(
    [box()], [("table", "box", 0.5, 4)], [("table", Box(size=(1600, 1200, 40)), (0, 0, -20))]
)

# %% sizes-apart: a ball in micrometres
found = findings(
    [box(), ball(2e-5, 1e-10, xyz=(0, 0, 0.10002))], [*STANDS, ("box", "ball", 0.5, 1)]
)

# %% unit-of-a-shape: a cloud in millimetres
found = findings(
    [box()],
    lies(k=5),
    cloud={"box": [(x, y, -0.05) for x in (-50, 50) for y in (-50, 50)]},
)

# %% unit-of-mu-omega: 3 was meant as 3 mm
found = findings([box()], mu_omega=3.0)
after = {"check the unit of mu_omega of contacts.floor_box": findings([box()], mu_omega=3e-3)}


# %% unit-of-mu-omega: six pads of 0.6 mm with the friction that MuJoCo gives by default, said once
pads = "".join(f'<geom size="0.0006" pos="{i / 100} 0 0"/>' for i in range(6))
body = f'<body pos="0 0 0.0006"><freejoint/>{pads}</body>'
floor = '<geom type="plane" size="1 1 0.1"/>'
condim = '<default><geom condim="4"/></default>'
text = f"<mujoco>{condim}<worldbody>{floor}{body}</worldbody></mujoco>"
found = mujoco_scenario(MjModel.from_xml_string(text), h=0.01, steps=1).findings()
(unit,) = (x for x in found if x.name == "unit-of-mu-omega")
assert unit.remedy.startswith("check the unit of the second number of friction of the geoms of ")
assert unit.cause.endswith("the size of the smaller body, 0.0012 m (5 more pairs are as suspect)")

# %% force-beyond-a-limit: a palm of 2 N bears 9.81 N, whatever its K_q is
palm = Body("palm", weak, actuated="all", xyz=(0, 0, -0.05))
found = findings([box(), palm], [("palm", "box", 0.5, 4)], steps=60)
(effort,) = (x for x in found if x.name == "force-beyond-a-limit")
assert effort.remedy.endswith("correct its effort in the URDF to 9.9 N or more")
assert effort.cause.endswith("; no K_q changes what it bears")
strong = Body("palm", weak.replace('effort="2"', 'effort="9.9"'), actuated="all", xyz=(0, 0, -0.05))
after = {effort.remedy: findings([box(), strong], [("palm", "box", 0.5, 4)], steps=60)}


# %% target-without-effect: the group of the actuator is switched off
found = of_mujoco('<option actuatorgroupdisable="3"/>', '<position joint="j" kp="9" group="3"/>')

# %% target-without-effect: a gain of zero, which a motor has by mistake
found = of_mujoco("", '<general joint="j" gainprm="0"/>')

# %% crossed-margin: a ball 8 mm above the floor, which a force moves by h^2 f / m, 20 mm
floor = '<geom type="plane" size="1 1 1"/><body pos="0 0 .108">'
ball_on_rail = '<joint name="z" type="slide" axis="0 0 1"/><geom size=".1" mass="1"/></body>'
pull = '<actuator><motor name="down" joint="z"/></actuator>'
text = (
    f'<mujoco><option gravity="0 0 0"/><worldbody>{floor}{ball_on_rail}</worldbody>{pull}</mujoco>'
)
scene = mujoco_scenario(
    MjModel.from_xml_string(text), targets=lambda t: {"down": -200.0}, steps=1, margin=0.004
)
found = scene.run(progress=False).findings
assert next(x for x in found if x.name == "crossed-margin").numbers["depth_mm"] == pytest.approx(
    12.0
)
scene = mujoco_scenario(
    MjModel.from_xml_string(text), targets=lambda t: {"down": -200.0}, steps=1, margin=0.03
)
after = {"raise margin, or take a smaller h": scene.run(progress=False).findings}


# %% target-beyond-a-limit: the URDF ends at 1 m
found = findings([motor("finger")], [], target=[1.5])
remedy = "change the target, or the limit in the URDF"
after = {remedy: findings([motor("finger")], [], target=[1.0])}


# %% joint-beyond-a-limit: a drawer at 0.98 m, whose URDF ends at 1 m, is pushed on by 60 mm
drawer = Body("drawer", joint("prismatic", "1 0 0"), positions={"joint": 0.98})
found = findings([drawer], [], push={"drawer/part": (400, 0, 0)}, steps=3)

# %% sunk-contact: a box of a hundred points, of which one is kept, tips farther than a step foresees
found = findings([box()], lies(k=1), cloud={"box": FACE}, push={"box": (0, 0, -20)}, steps=3)
(sunk,) = (x for x in found if x.name == "sunk-contact")
assert sunk.remedy == "raise k of contacts.floor_box"
assert " was not among its 1 closest at step " in sunk.cause
every = findings([box()], lies(k=100), cloud={"box": FACE}, push={"box": (0, 0, -20)}, steps=3)
after = {sunk.remedy: every}


# %% sunk-contact: a rod on one point of its side
rod = Body.of_shape("rod", Cylinder(0.01, 0.1), 0.2, xyz=(0, 0, 0.01), rpy=(0, np.pi / 2, 0))
found = findings([rod], lies("rod", k=1), push={"rod": (0, 0.05, 0)}, steps=20)
remedy = "take a smaller h or move slower, or raise k of contacts.floor_rod"
assert remedy in [x.remedy for x in found]
after = {remedy: findings([rod], lies("rod", k=4), push={"rod": (0, 0.05, 0)}, steps=20)}


# %% starts-in-the-air, free-fall: a box far above a floor does not lie on one point of it
found = findings([box(xyz=(0, 0, 1))], lies(k=1))
assert len(found) == 2
lowered = findings([box(xyz=(0, 0, 0.05))], lies(k=4))
after = {
    "lower box by 950 mm, or check its origin": lowered,
    "start it on what should bear it": lowered,
}


# %% free-fall: a floor whose normal points down
found = findings(
    [box(xyz=(0, 0, 0.3))],
    [("ceiling", "box", 0.5, 4)],
    [("ceiling", HalfSpace((0, 0, -1.0), -1.0), (0, 0, 0))],
)

# %% free-fall: a smooth box slips from between two fingers, of which 2 mm are left
found = findings(
    [box(xyz=(0, 0, 1)), *fingers(0.1, 1.098)],
    [("left", "box", 0.0, 4), ("right", "box", 0.0, 4)],
    target=[0.01, 0.01],
    steps=8,
)
remedy = "hold it more firmly or longer, or put something below it"
below = ("below", Box(size=(0.4, 0.4, 0.1)), (0, 0, 0.9))
borne = findings(
    [box(xyz=(0, 0, 1)), *fingers(0.1, 1.098)],
    [("left", "box", 0.0, 4), ("right", "box", 0.0, 4), ("below", "box", 0.5, 4)],
    [below],
    target=[0.01, 0.01],
    steps=8,
)
after = {remedy: borne}


# %% free-fall: a ball past the end of its table
table = ("table", Box(size=(0.4, 0.4, 0.04)), (0, 0, -0.02))
found = findings([ball(0.02, xyz=(0.23, 0, 0.02))], [("table", "ball", 0.5, 1)], [table])

# %% failing-backend: twelve digits of OSQP, which gives nine
found = findings([box()], push={"box": (3, 0, 0)}, backend="osqp", accuracy=1e-24)
remedy = "choose another backend than osqp, such as clarabel or daqp"
after = {remedy: findings([box()], push={"box": (3, 0, 0)}, backend="daqp", accuracy=1e-12)}


# %% uncertain-forces: a box under a press of 1e9 N/m, which bears 1 N
press = motor("press", "0 0 1", xyz=(0, 0, 0.15))
found = findings(
    [box(), press], [*STANDS, ("box", "press", 0.5, 4)], steps=1, K_q=1e9, target=[[-1e-9]]
)
remedy = "read the sum of forces of each pair in the place of single ones, or take a softer K_q"
soft = findings(
    [box(), press], [*STANDS, ("box", "press", 0.5, 4)], steps=1, K_q=1e4, target=[[-1e-4]]
)
after = {remedy: soft}


# %% time-of-proof: 11 of 12 s (those of a long run, written here)
found = findings([box()], seconds={"solve": 1.0, "proof": 11.0})
remedy = 'take certify = "residual", which judges each step by its residuals in less time'
after = {remedy: findings([box()], seconds={"solve": 1.0, "proof": 0.1}, certify="residual")}
