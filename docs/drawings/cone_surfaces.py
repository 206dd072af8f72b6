"""Friction cones: what a contact can bear at a normal force of 1 N, in its three directions.

The paper's six rows share one normal force, which makes an octahedron of the two tangential forces
and the torque about n. The ellipsoid is what experiments suggest; the product lets the torque have
its limit whatever the tangential force. Their volumes compare how much they hold.
"""

from collections.abc import Sequence

from quasistatic_ref.lab.figures.cones import SHOWN, limit_surfaces
from quasistatic_ref.optional.show.figures import Figure


def figure(*, cones: Sequence[str] = SHOWN) -> Figure:
    """The surfaces of some cones, side by side.

    Parameters
    ----------
    cones : sequence of str
        As ``cone`` of a step.
    """
    return limit_surfaces(cones)
