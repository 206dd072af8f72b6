"""A block on a floor, by its step."""

import numpy as np

from quasistatic_ref import Extra
from tests.made import rigid_step

H = 0.01
M = 1.0
G = 9.81
MU_V = 0.5
CORNERS = [[x, y, -0.03] for x in (0.05, -0.05) for y in (0.05, -0.05)]
POLYHEDRAL = ("pyramid", "product", "facets-6", "frictionless")


def block(push=0.0):
    """A block of 0.1 x 0.1 x 0.06 m on four corners, pushed at its bottom."""
    wrench = [push, 0, -M * G, 0, 0.03 * -push, 0]
    friction = {"mu_v": MU_V, "mu_omega": 0.01, "rows": 6}
    return rigid_step(M, (0.002, 0.002, 0.003), wrench, CORNERS, [np.eye(3)] * 4, **friction, h=H)


def walled_block():
    """One that slides against a wall, x <= 0.1 mm, before another one, x <= 1 m."""
    rows = Extra(("beyond", "wall"), -np.eye(6)[[0, 0]], [-1.0, -1e-4])
    return block(push=9.0).replace(extra=rows)
