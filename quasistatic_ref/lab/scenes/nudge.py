"""One small free body on a floor, and a finger that nudges it, to look at gradients."""

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.scenes.systems import on_link, world_plane
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.system import System
from quasistatic_ref.optional.fast.simulator import FastSimulator
from quasistatic_ref.shapes.placed_shape import PointCloud, Shape, Sphere
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.data import Array

RADIUS, MASS, MU_V, MU_OMEGA, H = 0.05, 0.3, 0.4, 0.01, 0.01
"""Of the ball [m] and [kg], of all contacts [-] and [m], and of a step [s]."""


def body_at_rest(shape: Shape, height: float) -> tuple[Simulator, Array]:
    """A free body on the floor, and its configuration with the origin at a height [m], (7,).

    Parameters
    ----------
    shape : Sphere or PointCloud
        What touches; of a cloud the closest point alone is kept.
    height : float
        [m].
    """
    system = System([Body.of_shape("ball", Sphere(RADIUS), MASS, xyz=(0, 0, height))])
    placed = on_link(system, "ball", shape)
    pair = ContactPair("floor", world_plane(), placed, MU_V, MU_OMEGA, 6, 1)
    simulator = Simulator(system, [pair], h=H, K_q=np.zeros((0, 0)))
    return FastSimulator(simulator), system.q_start


def nudged_ball(finger: Shape, finger_at: tuple[float, float]) -> tuple[Simulator, Array]:
    """A ball at the origin and a finger next to it, at some x and y [m]; q has shape (14,).

    Parameters
    ----------
    finger : Sphere or HalfSpace
        In a frame along the world's axes.
    finger_at : (float, float)
        x and y of its frame [m].
    """
    hand = Body.of_shape("hand", Sphere(RADIUS), MASS, actuated=("base",), xyz=(*finger_at, RADIUS))
    ball = Body.of_shape("ball", Sphere(RADIUS), MASS, xyz=(0, 0, RADIUS))
    system = System([hand, ball])
    ball_shape = on_link(system, "ball", Sphere(RADIUS))
    pairs = [
        ContactPair("floor", world_plane(), ball_shape, MU_V, MU_OMEGA, 6, 1),
        ContactPair("push", on_link(system, "hand", finger), ball_shape, MU_V, MU_OMEGA, 6, 1),
    ]
    K_q = np.diag([2000.0] * 3 + [20.0] * 3)
    return FastSimulator(Simulator(system, pairs, h=H, K_q=K_q)), system.q_start


def points(*places: tuple[float, float, float]) -> PointCloud:
    """A cloud of a few `places`, three numbers each [m]."""
    return PointCloud(np.array(places))
