"""A quasi-dynamic simulator of one scene in plain NumPy, which shares nothing with ours.

A finger on a rail pushes a sphere along a floor, with torsion at both contacts. The steps are those
of the plain program of the reference vectors.
"""

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.lab.program.rotation import rotation
from quasistatic_ref.lab.program.step import step
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.systems import (
    RAIL,
    body_text,
    on_link,
    simulator_of,
    system_of,
    world_plane,
)
from quasistatic_ref.shapes.placed_shape import Box, Sphere
from quasistatic_ref.step.data import Array

M = 0.3
INERTIA = 3e-4
RADIUS = 0.05
H = 0.01
STIFFNESS = 500.0
SPEED = 0.03
STEPS = 60
FLOOR, FINGER = (0.3, 0.004), (0.6, 0.01)
"""(mu_v, mu_omega) of the two contacts."""

TIP = (0.02, 0.4, 0.4)
"""Sides of the finger, whose face starts at x = 0 [m]."""

START = np.array([RADIUS + 0.002, 0.01, RADIUS])
"""Centre of the sphere [m]."""

TORQUE = np.array([0.0, 0.0, 0.02])
"""On the sphere, about the vertical, so that it spins as well [N m]."""

DRIFT = 1e-12
"""Of positions after 60 steps, over the way: what both round in a step adds up; measured 2e-15."""


def pose(*xyz: float) -> dict[str, list[float]]:
    """A pose without a turn, at x, y, z [m]."""
    return {"xyz": list(xyz), "quaternion": [0.0, 0.0, 0.0, 1.0]}


BODIES = [
    {"name": "finger", "parent": None, "placement": pose(-TIP[0] / 2, 0, RADIUS),
     "joint": "prismatic", "axis": [1, 0, 0], "actuated": True},
    {"name": "ball", "parent": None, "placement": pose(0, 0, 0), "joint": "floating",
     "mass": M, "com": [0, 0, 0], "inertia": (INERTIA * np.eye(3)).tolist()},
]  # fmt: skip
SHAPES = {
    "floor": (None, {"kind": "halfspace", "normal": [0, 0, 1], "offset": 0.0}),
    "finger": ("finger", {"kind": "box", "size": list(TIP)}),
    "ball": ("ball", {"kind": "sphere", "radius": RADIUS}),
}
SCENE = {
    "h": H, "cone": "pyramid", "gravity": [0, 0, -GRAVITY], "K_q": [[STIFFNESS]],
    "mechanism": {"bodies": BODIES},
    "shapes": {
        name: {"body": body, "pose": pose(0, 0, 0), "shape": shape}
        for name, (body, shape) in SHAPES.items()
    },
    "pairs": [
        {"name": name, "alpha": name, "beta": "ball", "k": 1, "rows": 6,
         "mu_v": mu_v, "mu_omega": mu_omega}
        for name, (mu_v, mu_omega) in (("floor", FLOOR), ("finger", FINGER))
    ],
    "wrenches": [{"body": "ball", "force": [0, 0, 0], "torque": TORQUE.tolist()}],
}  # fmt: skip
"""The scene as a case of the vectors' layer ``step``."""


def by_the_program() -> Array:
    """Finger, centre and rotation matrix after each step, shape (STEPS, 13)."""
    q = np.array([0.0, *START, 0.0, 0.0, 0.0, 1.0])
    states = []
    for k in range(STEPS):
        q = step(SCENE | {"q": q, "q_bar_a": [SPEED * H * (k + 1)]})["q_next"]
        states.append(np.concatenate([q[:4], rotation(q[4:]).ravel()]))
    return np.array(states)


def by_us() -> Array:
    """The same from a URDF, through System and Simulator, shape (STEPS, 13)."""
    system = system_of(
        {"rail": RAIL, "ball": body_text(M, (INERTIA,) * 3)},
        rail={"base": "fixed", "actuated": "all", "xyz": (-TIP[0] / 2, 0.0, RADIUS)},
        ball={"xyz": tuple(START)},
    )
    tip = on_link(system, "rail/finger", Box(np.array(TIP) / 2))
    sphere = on_link(system, "ball", Sphere(RADIUS))
    pairs = (
        ContactPair("floor", world_plane(), sphere, *FLOOR, 6, 1),
        ContactPair("finger", tip, sphere, *FINGER, 6, 1),
    )
    simulator = simulator_of(system, pairs, H, [[STIFFNESS]])
    q = system.q_start
    states = []
    link = system.link("ball")
    for k in range(STEPS):
        torque = system.centre_of_mass_force(q, "ball", np.zeros(3), TORQUE)
        q = simulator.step(q, np.array([SPEED * H * (k + 1)]), torque).q
        at = system.kinematics(q)
        states.append(np.concatenate([q[:1], at.t[link], at.R[link].ravel()]))
    return np.array(states)


def evidence() -> Evidence:
    """Sixty steps from touching nothing to rolling, sliding and spinning."""
    hand = by_the_program()
    ours = by_us()
    way = np.linalg.norm(ours[-1, 1:4] - START)
    return Evidence.of(
        comparison("finger and centre of the sphere [m]", ours[:, :4], hand[:, :4], DRIFT, way),
        comparison("rotation matrix [-]", ours[:, 4:], hand[:, 4:], DRIFT),
    )


CLAIM = Claim(
    name="by_hand",
    sentence="The plain program of the reference vectors, in NumPy without any robotics stack and "
    "without any solver of others, goes the same way, step after step.",
    where="the paper, Eqs. (2)-(8), (13)",
    sweep="a finger pushes a sphere that is also spun by a torque, 60 steps",
    reason="DRIFT, relative to the way of the sphere.",
    measure=evidence,
)
