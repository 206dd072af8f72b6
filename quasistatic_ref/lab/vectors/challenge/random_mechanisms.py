"""Mechanisms at random: trees of all kinds of joints, and their configurations.

Numbers are rounded to few digits, so that cases can be read.
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.made_steps.at_random import Rng
from quasistatic_ref.lab.program.mechanism import slices
from quasistatic_ref.lab.vectors.tables import at, follower, link
from quasistatic_ref.lab.vectors.trees import Json

KINDS = ("revolute", "prismatic", "continuous", "fixed")
BASES = ("floating", "planar")
"""Joints that hang in the world alone."""


def few_digits(values: Any, digits: int = 3) -> list[float]:
    """Numbers rounded to some decimal places."""
    return [round(float(x), digits) + 0.0 for x in np.asarray(values).ravel()]


def random_quaternion(rng: Rng) -> list[float]:
    """Four numbers of three decimal places: mostly of another length than one."""
    return few_digits(rng.uniform(-1, 1, 4) + 0.05)


def random_pose(rng: Rng, size: float = 1.0) -> Json:
    """A pose within a cube of half the side `size` [m]."""
    return {"xyz": few_digits(rng.uniform(-size, size, 3)), "quaternion": random_quaternion(rng)}


def mass(rng: Rng) -> Json:
    """Mass, centre and inertia that a body can have: that of two masses and a ball.

    In one of four the centre is at the origin, and not said.
    """
    a = few_digits(rng.uniform(0.01, 0.05, 2))
    b = few_digits(rng.uniform(-0.1, 0.1, 3), 2)
    x, y, z = b
    ball = a[0]
    inertia = [
        [ball + y * y + z * z, -x * y, -x * z],
        [-x * y, ball + x * x + z * z, -y * z],
        [-x * z, -y * z, ball + x * x + y * y],
    ]
    centre = {"com": few_digits(rng.uniform(-0.1, 0.1, 3))} if rng.integers(4) else {}
    heavy = few_digits(rng.uniform(0.1, 3, 1))[0]
    return {"mass": heavy, **centre, "inertia": [few_digits(row, 6) for row in inertia]}


def random_tree(rng: Rng, count: int, base: str) -> Json:
    """A tree of bodies: each hangs on one of the two before it."""
    bodies = []
    for k in range(count):
        joint = base if k == 0 else str(rng.choice(KINDS, p=[0.45, 0.2, 0.2, 0.15]))
        body = link(
            f"body{k}",
            None if k == 0 else f"body{max(0, k - 1 - int(rng.integers(2)))}",
            joint,
            axis=few_digits(rng.uniform(-1, 1, 3) + 0.01),
            actuated=bool(joint != "fixed" and rng.integers(2)),
        )
        if joint == "planar":
            body["placement"] = at(0.0, 0.0, few_digits(rng.uniform(0, 1, 1))[0])
        elif joint != "floating":
            body["placement"] = random_pose(rng, 0.5)
        bodies.append(body | mass(rng))
    return {"bodies": bodies}


def random_follower(rng: Rng, parent: str) -> list[Json]:
    """A joint, one that follows it, beside it or on it, and perhaps a body that turns on that."""
    joint = str(rng.choice(["revolute", "prismatic"]))
    bodies = follower(joint, parent, actuated=bool(rng.integers(2)))
    if rng.integers(2):  # the last link of a coupled finger, on the joint that it follows
        bodies[1] |= {"parent": "drive", "placement": random_pose(rng, 0.3)}
    if rng.integers(3) == 0:
        tip = {"axis": few_digits(rng.uniform(-1, 1, 3) + 0.01), "actuated": bool(rng.integers(2))}
        kind = str(rng.choice(["revolute", "continuous"]))
        bodies.append(link("tip", "finger", kind, placement=random_pose(rng, 0.5), **tip))
    return bodies


def random_q(rng: Rng, mechanism: Json) -> list[float]:
    """A configuration in the paper's order; quaternions and (cos, sin) not normalised."""
    q: list[float] = []
    for actuated in (True, False):
        for body in mechanism["bodies"]:
            has_coordinate = body["joint"] != "fixed" and "mimic" not in body
            if has_coordinate and body["actuated"] == actuated:
                q += _random_position(rng, body["joint"])
    return q


def _random_position(rng: Rng, kind: str) -> list[float]:
    match kind:
        case "floating":
            return [*few_digits(rng.uniform(-1, 1, 3)), *random_quaternion(rng)]
        case "planar":
            return [*few_digits(rng.uniform(-1, 1, 2)), *few_digits(rng.uniform(0.1, 1, 2))]
        case "continuous":
            return few_digits(rng.uniform(0.1, 1, 2) * np.array([-1, 1]))
        case _:
            return few_digits(rng.uniform(-2, 2, 1))


def random_step(rng: Rng, mechanism: Json, size: float) -> list[float]:
    """Some delta_q of few significant digits, of about the `size` [m, rad]."""
    _, _, n_v = slices(mechanism)
    return [float(f"{x:.3g}") for x in rng.uniform(-size, size, n_v)]
