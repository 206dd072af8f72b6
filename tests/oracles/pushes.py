"""A finger that pushes a free body along a tilted floor, both of any shapes, in random poses."""

from typing import Any, Final

import numpy as np

from quasistatic_ref.contact.distance import pair_closest_points
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.system import System
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    PlacedShape,
    PointCloud,
    Shape,
    Sphere,
)
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.data import Array

CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
SHAPES: Final[dict[str, Shape]] = {
    "sphere": Sphere(0.05),
    "box": Box(np.array([0.05, 0.06, 0.04])),
    "cylinder": Cylinder(0.04, 0.06),
    "capsule": Capsule(0.03, 0.05),
    "cone": Cone(0.05, 0.06),
    "ellipsoid": Ellipsoid(np.array([0.04, 0.06, 0.05])),
    "mesh": convex_hull(np.concatenate([0.04 * CORNERS, [[0.01, 0.02, 0.07], [0.06, 0.0, 0.01]]])),
    "cloud": PointCloud(
        0.05 * CORNERS * [1.0, 0.8, 1.1] + 0.004 * np.sin(np.arange(24)).reshape(8, 3)
    ),
}
FLOOR = HalfSpace(np.array([0.05, -0.1, 1.0]), 0.0)
MU_V, MU_OMEGA = 0.4, 0.01

STIFF = np.array([400.0, 500.0, 600.0, 4.0, 5.0, 6.0])


def pushed(
    rng: np.random.Generator,
    pusher: str = "sphere",
    moved: str = "box",
    k: int = 2,
    gap: float = 1e-4,
    **settings: Any,
) -> tuple[Simulator, Array, Array]:
    """A simulator, a configuration (14,) and a target of the finger (7,).

    Parameters
    ----------
    rng : Generator
    pusher, moved : str
        Names of SHAPES.
    k : int
        How many closest points the floor keeps; the finger keeps one, or two.
    gap : float
        Both gaps are half of it to all of it [m].
    settings : object
        Of the simulator.
    """
    hand = Body.of_shape("hand", Sphere(0.05), 0.5, actuated=("base",))
    body = Body.of_shape("body", Box(np.array([0.05, 0.06, 0.04])), 0.3)
    system = System([hand, body])
    own = {
        name: PlacedShape(name, system.link(name), np.eye(3), 0.005 * np.ones(3), SHAPES[kind])
        for name, kind in (("hand", pusher), ("body", moved))
    }
    floor = PlacedShape("floor", 0, np.eye(3), np.zeros(3), FLOOR)
    pairs = [
        ContactPair("floor", floor, own["body"], MU_V, MU_OMEGA, 6, k),
        ContactPair("push", own["hand"], own["body"], MU_V, MU_OMEGA, 6, min(k, 2)),
    ]
    own_settings: dict[str, Any] = {"h": 0.01, "K_q": np.diag(STIFF), "fast": True} | settings
    simulator = Simulator(system, pairs, **own_settings)
    q = system.q_start.copy()
    for at in (3, 10):
        turn = rng.normal(size=4)
        q[at : at + 4] = turn / np.linalg.norm(turn)
    q[:3] = 0.12 * rng.normal(size=3) / np.sqrt(3) + [0.1, 0.0, 0.05]
    q[7:10] = 0.0
    for pair, at, sign in ((pairs[0], 7, -1.0), (pairs[1], 0, 1.0)):
        for _ in range(20):
            kinematics = system.kinematics(q)
            found = pair_closest_points(pair, kinematics.R, kinematics.t)
            j = int(found.phi.argmin())
            move = (found.phi[j] - gap * rng.uniform(0.5, 1.0)) * found.n[j]
            q[at : at + 3] += sign * move
            if abs(found.phi[j]) < 2 * abs(gap):
                break
    away = np.concatenate(
        [3e-3 * found.n[j] + 1e-3 * rng.normal(size=3), 0.02 * rng.normal(size=3)]
    )
    R = system.kinematics(q).R[system.link("hand")]
    target = np.concatenate([R.T @ away[:3], away[3:], np.zeros(6)])
    return simulator, q, system.integrate(q, target)[: system.n_q_a]
