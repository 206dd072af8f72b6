"""A quasi-dynamic simulator of one scene in plain NumPy, which shares nothing with ours.

A finger on a rail pushes a sphere along a floor, with torsion at both contacts. The steps are those
of the plain program of the reference vectors.
"""

from collections.abc import Callable

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.lab.program.rotation import rotation
from quasistatic_ref.lab.program.step import step
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.vectors.own.step import posed_case, wrench_force
from quasistatic_ref.lab.vectors.tables import at
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

START = np.array([0.0, RADIUS + 0.002, 0.01, RADIUS, 0.0, 0.0, 0.0, 1.0])
"""The finger, and the pose of the sphere [m]."""

TORQUE = [0.0, 0.0, 0.02]
"""On the sphere, about the vertical, so that it spins as well [N m]."""

DRIFT = 1e-12
"""Of positions after 60 steps, over the way: what both round in a step adds up; measured 2e-15."""

BODIES = [
    {"name": "finger", "parent": None, "placement": at(-TIP[0] / 2, 0, RADIUS),
     "joint": "prismatic", "axis": [1, 0, 0], "actuated": True},
    {"name": "ball", "parent": None, "placement": at(0, 0, 0), "joint": "floating",
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
        name: {"body": body, "pose": at(0, 0, 0), "shape": shape}
        for name, (body, shape) in SHAPES.items()
    },
    "pairs": [
        {"name": name, "alpha": name, "beta": "ball", "k": 1, "rows": 6,
         "mu_v": mu_v, "mu_omega": mu_omega}
        for name, (mu_v, mu_omega) in (("floor", FLOOR), ("finger", FINGER))
    ],
    "wrenches": [{"body": "ball", "force": [0, 0, 0], "torque": TORQUE}],
}  # fmt: skip
"""The scene as a case of the vectors' layer ``step``."""


def configurations(after: Callable[[Array, Array], Array]) -> Array:
    """Finger, centre and rotation matrix after each step, shape (STEPS, 13).

    Parameters
    ----------
    after : callable
        From q and the target of the finger, shape (1,) [m], to the q after a step.
    """
    q = START
    states = []
    for k in range(STEPS):
        q = after(q, np.array([SPEED * H * (k + 1)]))
        states.append(np.concatenate([q[:4], rotation(q[4:]).ravel()]))
    return np.array(states)


def _by_the_program(q: Array, target: Array) -> Array:
    """The q after a step."""
    q_next: Array = step(SCENE | {"q": q, "q_bar_a": target})["q_next"]
    return q_next


def _by_us() -> Callable[[Array, Array], Array]:
    """The same from URDFs, through System and Simulator."""
    posed = posed_case(SCENE | {"q": START, "q_bar_a": START[:1]})
    mine = posed.mine

    def after(q: Array, target: Array) -> Array:
        q_model = mine.model_q(q.tolist())
        force = wrench_force(SCENE, mine, q_model)
        return posed.simulator.step(q_model, target, force).q[mine.q]

    return after


def evidence() -> Evidence:
    """Sixty steps from touching nothing to rolling, sliding and spinning."""
    hand = configurations(_by_the_program)
    ours = configurations(_by_us())
    way = np.linalg.norm(ours[-1, 1:4] - START[1:4])
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
