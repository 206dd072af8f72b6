"""A mug that hangs on a hook by its handle: a concave body as a cloud, and as a hull.

The handle is half of a torus in the plane of x and z, and the hook a capsule along y. The mug hangs
where the hook's axis, the middle of the torus and the centre of mass are on one vertical line: the
hook then touches the handle's inner circle.
"""

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.scenes.systems import body_text, system_of
from quasistatic_ref.shapes.placed_shape import Capsule, PlacedShape, PointCloud, Shape
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.data import Array

MASS = 0.3
"""[kg]."""
INERTIA = (5e-4, 5e-4, 4e-4)
"""[kg m^2]."""
OFF = 0.04
"""From the centre of mass to the middle of the torus, along x [m]: the radius of the mug."""
ARC, TUBE, HOOK = 0.028, 0.005, 0.006
"""Radii of the torus, of its tube and of the hook [m]."""
INNER = ARC - TUBE
"""Radius of the handle's inner circle [m]."""
NEAREST = 12
"""Candidates of the cloud."""
STEPS = 60
FRICTION = 0.3


@dataclass(frozen=True)
class Hung:
    """A mug after its steps on the hook.

    Parameters
    ----------
    sunk : float
        How far the centre of mass is below that of a mug with a smooth handle [m].
    moved : float
        How far it moved in the last step [m].
    """

    sunk: float
    moved: float


def handle_cloud(spacing: float, rng: np.random.Generator) -> Array:
    """Points of the handle on circles about its tube, shape (N, 3) [m], the mug's frame.

    Parameters
    ----------
    spacing : float
        Between circles along the inner circle, and of points along a circle [m]: at most so much.
    rng : Generator
        Where the first circle, and the first point of each circle, are.
    """
    circles = int(np.ceil(np.pi * INNER / spacing))
    each = int(np.ceil(2 * np.pi * TUBE / spacing))
    along = np.pi * (np.arange(circles) + rng.random()) / circles - np.pi / 2
    about = 2 * np.pi * (np.arange(each) + rng.random((circles, 1))) / each
    outwards = ARC + TUBE * np.cos(about)
    x, z = (outwards * f(along)[:, None] for f in (np.cos, np.sin))
    return np.stack([OFF + x, TUBE * np.sin(about), z], axis=-1).reshape(-1, 3)


def hung_mug(handle: Shape) -> Hung:
    """Hang a mug with that handle on the hook.

    It starts where one with a smooth handle hangs, 1 micrometre higher.

    Parameters
    ----------
    handle : Shape
        What touches, in the mug's frame.

    Raises
    ------
    LimitExceeded
        If the hook is deep within it.
    """
    turned = (0.0, -np.pi / 2, 0.0)  # the handle's x upwards
    height = -(OFF + INNER - HOOK)
    system = system_of(
        {"mug": body_text(MASS, INERTIA)},
        mug={"base": "floating", "xyz": (0.0, 0.0, height + 1e-6), "rpy": turned},
    )
    upright = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])  # z along y
    pair = ContactPair(
        "hook",
        PlacedShape("hook", 0, upright, np.zeros(3), Capsule(HOOK, 0.05)),
        PlacedShape("handle", system.link("mug"), np.eye(3), np.zeros(3), handle),
        mu_v=FRICTION,
        mu_omega=0.0,
        rows=4,
        k=NEAREST if isinstance(handle, PointCloud) else 1,
    )
    simulator = Simulator(system, [pair], h=0.01, K_q=np.zeros((0, 0)), fast=True)
    q = system.q_start
    before = 0.0
    for _ in range(STEPS):
        before = float(q[2])
        q = simulator.step(q, np.zeros(0)).q
    return Hung(sunk=height - float(q[2]), moved=abs(float(q[2]) - before))


def sink(spacing: float) -> float:
    """How far a mug sinks whose handle is points, at most [m].

    Between two points that are `spacing` apart on a circle of radius r the hook of radius R_h
    comes nearer to its middle: from r - R_h to r cos a - sqrt(R_h^2 - (r sin a)^2), a half of the
    angle between the points. The point of a circle about the tube that is next to the hook is off
    the inner circle by half of a spacing at most, and there the tube is farther from the hook.

    Parameters
    ----------
    spacing : float
        As for :func:`handle_cloud` [m].
    """
    a = spacing / (2 * INNER)
    between = INNER * np.cos(a) - np.sqrt(HOOK**2 - (INNER * np.sin(a)) ** 2)
    across = TUBE * (1 - np.cos(spacing / (2 * TUBE)))
    return float(between - (INNER - HOOK) + across)
