"""One small free body on a floor, to look at gradients."""

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.made_steps.systems import on_link, world_plane
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.placed_shape import PointCloud, Shape, Sphere
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.backends import DAQP

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
    return Simulator(system, [pair], h=H, backend=DAQP), system.q_start


def points(*places: tuple[float, float, float]) -> PointCloud:
    """A cloud of a few `places`, three numbers each [m]."""
    return PointCloud(np.array(places))
