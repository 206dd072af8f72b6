"""A free body on shapes that are fixed, the whole scene in a random place of the world."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.vectors.families.scenario_mechanism import pose_of
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.system import System
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import (
    Box,
    HalfSpace,
    PlacedShape,
    PointCloud,
    Shape,
    Sphere,
)
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.data import Array

H: Final = 0.01
G: Final = 9.81
MASS: Final = 0.3
WEIGHT: Final = MASS * G
"""[N]"""
FLOOR: Final = HalfSpace(np.array([0.0, 0.0, 1.0]), 0.0)
UP: Final = np.array([0.0, 0.0, 1.0])
HERE: Final = (np.eye(3), np.zeros(3))
POINT: Final = PointCloud(np.zeros((1, 3)))
"""A point at the body's centre of mass: forces through it do not turn it."""
X: Final = np.array([1.0, 0.0, 0.0])
Y: Final = np.array([0.0, 1.0, 0.0])
IN: Final = 1e-4
"""Depth of what is pressed on something [m]."""
Rng = np.random.Generator


def turned(axis: Sequence[float], angle: float) -> Array:
    """Rotation matrix (3, 3) about an axis of any length by an angle [rad]."""
    n = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    K = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return np.asarray(np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * (K @ K))


def unit_vector(rng: Rng, n: int) -> Array:
    """A random direction, shape (n,) [-]."""
    e = rng.normal(size=n)
    return np.asarray(e / np.linalg.norm(e))


def any_turn(rng: Rng) -> Array:
    """A random rotation matrix (3, 3)."""
    return turned(rng.normal(size=3), rng.uniform(0.2, 3.0))


def about_z(rng: Rng) -> Array:
    """A random rotation about z, shape (3, 3)."""
    return turned(UP, rng.uniform(-3, 3))


def spot(rng: Rng) -> Array:
    """A random place on the floor, shape (3,) [m]."""
    return np.array([*rng.uniform(-0.1, 0.1, 2), 0.0])


@dataclass(frozen=True)
class Kink:
    """A step at a kink.

    Parameters
    ----------
    kind : str
        The name that the verdict should have.
    what : str
        The construction.
    simulator : Simulator
    q, q_bar_a, force : ndarray
    also : frozenset of str
        Names that the verdict may have as well, as the same place is a kink for them too.
    where : frozenset of str
        Pairs that the verdict names, or a joint.
    """

    kind: str
    what: str
    simulator: Simulator
    q: Array
    force: Array
    q_bar_a: Array = field(default_factory=lambda: np.zeros(0))
    also: frozenset[str] = frozenset()
    where: frozenset[str] = frozenset({"c0"})


@dataclass(frozen=True)
class Scene:
    """A body and what is fixed, before the scene is moved.

    Parameters
    ----------
    shape : Shape
    R, t : ndarray
        The body's pose.
    fixed : sequence of (Shape, ndarray, ndarray)
        Shapes with their poses.
    k, mu, rows, cone : as of pairs and simulators
    force : ndarray, shape (6,)
        Force along the scene's axes [N], and torque [N m].
    """

    shape: Shape
    R: Array
    t: Array
    fixed: Sequence[tuple[Shape, Array, Array]]
    k: int = 1
    mu: tuple[float, float] = (0.5, 0.01)
    rows: int = 6
    cone: str = "pyramid"
    force: Array = field(default_factory=lambda: np.array([0.3, 0.2, -2.0, 0.001, 0.002, 0.001]))


def placed(scene: Scene, R: Array, t: Array) -> tuple[Simulator, Array, Array]:
    """Simulator, q and generalised force of a scene that is moved by R and t; gravity turns too."""
    system = System([Body.of_shape("body", Sphere(0.05), MASS)])
    own = PlacedShape("body", system.link("body"), np.eye(3), np.zeros(3), scene.shape)
    pairs = [
        ContactPair(
            f"c{i}",
            PlacedShape(f"f{i}", 0, R @ R_i, R @ t_i + t, shape),
            own,
            *scene.mu,
            scene.rows,
            scene.k,
        )
        for i, (shape, R_i, t_i) in enumerate(scene.fixed)
    ]
    gravity = tuple((-G * R @ UP).tolist())
    simulator = Simulator(
        system, pairs, h=H, K_q=np.zeros((0, 0)), gravity=gravity, cone=scene.cone
    )
    R_body = R @ scene.R
    q = np.concatenate([R @ scene.t + t, quaternion_of(R_body)])
    # delta_q of a free body is along its own axes.
    whole = np.concatenate([scene.R.T @ scene.force[:3], scene.R.T @ scene.force[3:]])
    return simulator, q, whole


def quaternion_of(R: Array) -> Array:
    """Quaternion [x y z w] of a rotation matrix, shape (4,)."""
    return np.array(pose_of(R, np.zeros(3))["quaternion"])


def anywhere(rng: Rng, scene: Scene, *, turn: bool = True) -> tuple[Simulator, Array, Array]:
    """A scene moved at random, or only shifted."""
    R = any_turn(rng) if turn else np.eye(3)
    return placed(scene, R, 0.2 * rng.normal(size=3))


def box(rng: Rng) -> Box:
    """A box of some centimetres."""
    return Box(rng.uniform(0.04, 0.12, 3))


def as_mesh(solid: Box) -> Shape:
    """The same as a convex mesh."""
    signs = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    return convex_hull(np.array(signs, dtype=float) * solid.half_extents)


def either(rng: Rng, solid: Box) -> Shape:
    """A box, or a mesh that is one."""
    return solid if rng.integers(2) else as_mesh(solid)
