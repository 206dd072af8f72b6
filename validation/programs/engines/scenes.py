"""Scenes that every engine can build: spheres and boxes, one coefficient for every pair.

Units are SI; axes are those of the world, z up. Bodies start at rest, and touch without overlap or
fall. A body's origin is its centre of mass, and its inertia is along its axes. Restitution is zero.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

GRAVITY = 9.81
"""[m/s^2]."""

TIME_STEP = 1e-3
"""Of every engine [s]."""


@dataclass(frozen=True)
class Shape:
    """A sphere of a radius, or a box of three lengths [m], with its centre in the body's frame."""

    kind: Literal["sphere", "box"]
    size: tuple[float, ...]
    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if self.kind not in ("sphere", "box"):
            raise ValueError(f"no engine here knows the shape {self.kind!r}; use sphere or box")


@dataclass(frozen=True)
class Body:
    """A body that is free, fixed, slides along x, or turns about z; joints have no friction."""

    name: str
    joint: Literal["free", "fixed", "rail_x", "hinge_z"]
    mass: float
    inertia: tuple[float, float, float]
    xyz: tuple[float, float, float]
    shapes: tuple[Shape, ...]


@dataclass(frozen=True)
class Load:
    """A force [N] and a torque [N m] on a body, at its centre of mass, from a time [s] on."""

    body: str
    start: float
    force: tuple[float, float, float] = (0.0, 0.0, 0.0)
    torque: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Turning:
    """A body that turns about z: evenly faster up to a time [s], then at a rate [rad/s]."""

    body: Body
    rate: float
    until: float

    def angle(self, t: float) -> float:
        """At a time [s]."""
        spun_up = min(t, self.until)
        return self.rate * (spun_up**2 / (2 * self.until) + max(0.0, t - self.until))

    @property
    def loads(self) -> tuple[Load, Load]:
        """Torques that turn it so, where what it carries is light."""
        torque = self.body.inertia[2] * self.rate / self.until
        start = Load(self.body.name, 0.0, torque=(0.0, 0.0, torque))
        return start, Load(self.body.name, self.until, torque=(0.0, 0.0, -torque))


@dataclass(frozen=True)
class Scene:
    """Bodies and loads; `times` [s] are those at which poses are read.

    What turns is driven by loads, or, where bodies have no velocity, to its angles.
    """

    bodies: tuple[Body, ...]
    mu_v: float
    mu_omega: float
    times: tuple[float, ...]
    loads: tuple[Load, ...] = ()
    gravity: float = GRAVITY
    floor: bool = True
    turning: Turning | None = None

    def wrenches(self, t: float) -> dict[str, np.ndarray]:
        """Force and torque on each body in the step that begins at a time, shape (2, 3)."""
        total = {body.name: np.zeros((2, 3)) for body in self.bodies}
        for load in self.loads:
            if t > load.start - TIME_STEP / 2:
                total[load.body] += [load.force, load.torque]
        return total


class NotMeaningful(Exception):
    """A question that an engine cannot be asked, with its reason."""


class Engine(Protocol):
    """A scene in an engine, with one of its settings; one file each in this folder."""

    def step(self, wrenches: dict[str, np.ndarray]) -> None:
        """One step under loads."""

    def pose(self, name: str) -> list[float]:
        """Place of a body and its quaternion: x, y, z, qx, qy, qz, qw."""

    def normal_forces(self) -> list[tuple[np.ndarray, float]]:
        """Point [m] and normal force [N] of each contact in the last step.

        Raises
        ------
        NotMeaningful
            If the engine has no forces of single contacts.
        """


@dataclass(frozen=True)
class Motion:
    """Of the first body of a scene, at k times.

    Parameters
    ----------
    scene : Scene
    places : ndarray, shape (k, 3)
        [m].
    turns : ndarray, shape (k - 1,)
        From one time to the next [rad].
    engine : Engine
        After the last step.
    """

    scene: Scene
    places: np.ndarray
    turns: np.ndarray
    engine: Engine

    @property
    def middle(self) -> int:
        """Number of the sample from which on it is looked at."""
        return len(self.places) // 2

    @property
    def distance(self) -> float:
        """From the middle sample to the last [m]."""
        return float(np.linalg.norm(self.places[-1] - self.places[self.middle]))

    @property
    def seconds(self) -> float:
        """From the middle sample to the last."""
        return self.scene.times[-1] - self.scene.times[self.middle]


def simulated(scene: Scene, engine: Engine, h: float = TIME_STEP) -> Motion:
    """The motion of a scene's first body, in steps of h [s].

    Raises
    ------
    NotMeaningful
        If poses are read between steps.
    ValueError
        If a state is no number.
    """
    if np.abs(np.array(scene.times) / h - np.round(np.array(scene.times) / h)).max() > 1e-6:
        raise NotMeaningful(f"poses are read oftener than every {h:g} s")
    poses = np.array(list(_poses(scene, engine, h)))
    if not np.isfinite(poses).all():
        k = int(np.flatnonzero(~np.isfinite(poses).all(axis=1))[0])
        raise ValueError(f"the state at {scene.times[k]:g} s is no number")
    return Motion(scene, poses[:, :3], _turns(poses[:, 3:]), engine)


def _poses(scene: Scene, engine: Engine, h: float) -> Iterator[list[float]]:
    """Poses of the first body at the scene's times."""
    done = 0
    for instant in scene.times:
        for k in range(done, round(instant / h)):
            engine.step(scene.wrenches(k * h))
        done = round(instant / h)
        yield engine.pose(scene.bodies[0].name)


def _turns(q: np.ndarray) -> np.ndarray:
    """Angles between successive quaternions; exact where they are small."""
    q = q / np.linalg.norm(q, axis=1, keepdims=True)
    v, w = q[:, :3], q[:, 3:]
    vector = w[:-1] * v[1:] - w[1:] * v[:-1] - np.cross(v[:-1], v[1:])
    scalar = np.abs((q[:-1] * q[1:]).sum(1))
    return 2 * np.arctan2(np.linalg.norm(vector, axis=1), scalar)


def times(first: float, last: float, every: float) -> tuple[float, ...]:
    """Times at which poses are read."""
    return tuple(round(float(t), 9) for t in np.arange(first, last + every / 2, every))
