"""One free body on a shape that is fixed in the world, and scenes of the reference vectors."""

import numpy as np

from quasistatic_ref import (
    Body,
    Box,
    Capsule,
    ContactPair,
    Cylinder,
    HalfSpace,
    PointCloud,
    Simulator,
    Sphere,
    System,
)
from quasistatic_ref.lab.vectors.own.step import posed_case
from tests.contact.still import placed_shape
from tests.lab.vectors.committed_cases import cases

H = 0.01
G = 9.81
NONE = np.zeros(0)
FLOOR = HalfSpace((0.0, 0.0, 1.0), 0.0)
BOX = Box((0.1, 0.1, 0.05))
POINT = PointCloud(np.zeros((1, 3)))


def free(shape, xyz, fixed, k=1, mu=(0.5, 0.01), rpy=(0.0, 0.0, 0.0), base="floating"):
    """(simulator, q) of one free body on a shape that is fixed at the world's origin."""
    solid = shape if isinstance(shape, Box | Sphere | Cylinder | Capsule) else Sphere(0.05)
    system = System([Body.of_shape("body", solid, 0.3, xyz=xyz, rpy=rpy, base=base)])
    own = placed_shape(shape, system.link("body"))
    pair = ContactPair("c0", placed_shape(fixed), own, *mu, 6, k)
    return Simulator(system, [pair], h=H, K_q=1.0, backend="daqp"), system.q_start


def vector_scene(name, **settings):
    """(simulator, q, q_bar_a) of a vector of derivatives, with other settings of the simulator."""
    (case,) = [case for case in cases("derivative") if case.id == f"derivative/{name}"]
    posed = posed_case(case.input)
    return Simulator(**posed.simulator.settings() | settings), posed.q, posed.q_bar_a


def falling_ball(gap=0.0):
    """(simulator, q) of a ball that falls as far as the floor in a step, but for a gap [m]."""
    return free(Sphere(0.05), (0, 0, 0.05 + H**2 * G + gap), FLOOR)


def slope(simulator, q_next, q, way, force=0.0, change=0.0, size=1e-6):
    """How the end of a step at q_next changes along a way of q and a change of the force.

    Richardson's difference to one side, without a term of the second order.
    """
    move = simulator.system.integrate
    near, far = (
        simulator.system.difference(
            q_next, simulator.step(move(q, t * way), NONE, force + t * change).q
        )
        for t in (size, 2 * size)
    )
    return (4 * near - far) / (2 * size)
