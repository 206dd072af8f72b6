"""Friction cones: what a contact can bear at a normal force of 1 N, in its three directions.

The paper's six rows share one normal force, which makes an octahedron of the two tangential forces
and the torque about n. The ellipsoid is what experiments suggest; the product lets the torque have
its limit whatever the tangential force. Their volumes compare how much they hold.
"""

from collections.abc import Sequence

import numpy as np
from scipy.spatial import ConvexHull

from quasistatic_ref.lab.figures.cones import SHOWN, limit_surfaces
from quasistatic_ref.optional.show.figures import Figure
from quasistatic_ref.step.cones import cone_matrix


def main() -> dict[str, float]:
    """Volumes of the limit surfaces, in units of mu_v, mu_v and mu_omega."""
    volumes = {name: ConvexHull(cone_matrix(name)[:, 1:]).volume for name in ("pyramid", "product")}
    volumes["ellipsoid"] = 4 / 3 * np.pi
    return {f"volume of the {name} [-]": volume for name, volume in volumes.items()}


def figure(*, cones: Sequence[str] = SHOWN) -> Figure:
    """The surfaces of some cones, side by side.

    Parameters
    ----------
    cones : sequence of str
        As ``cone`` of a step.
    """
    return limit_surfaces(cones)
