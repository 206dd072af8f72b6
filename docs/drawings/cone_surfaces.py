"""Friction cones: what a contact can bear at a normal force of 1 N, in its three directions.

The paper's six rows share one normal force, which makes an octahedron of the two tangential forces
and the torque about n. The ellipsoid is what experiments suggest; the product lets the torque have
its limit whatever the tangential force. Their volumes compare how much they hold.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from scipy.spatial import ConvexHull

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.friction import cone_matrix
from quasistatic_ref.optional.show.figures.looks import CAMERA
from quasistatic_ref.optional.show.figures.style import panels, scaled
from quasistatic_ref.step.cones import ELLIPSOID, PYRAMID

SHOWN = (PYRAMID, ELLIPSOID, "product")
SURFACE: dict[str, Any] = {"alpha": 0.5, "edgecolor": "k"}
OF_LABELS = 21
"""What matplotlib adds to the pads of labels of axes in space, at every size of the text [pt]."""
OF_TICKS = 8
"""The same of ticks."""
SAME_PLANE = 9
"""Decimals to which the planes of two triangles agree that are parts of one face."""


def figure(*, cones: Sequence[str] = SHOWN) -> Figure:
    """The surfaces of some cones side by side, in units of mu_v, mu_v, mu_omega.

    Parameters
    ----------
    cones : sequence of str
        As ``cone`` of a step.
    """
    space = {"projection": "3d"}
    page, grid = panels(6.3, 2.6, columns=len(cones), subplot_kw=space)
    colours = plt.rcParams["axes.prop_cycle"].by_key()["color"]
    for k, (axes, name) in enumerate(zip(grid, cones, strict=True)):
        colour = colours[k % len(colours)]
        if name == ELLIPSOID:
            u, v = np.mgrid[0 : 2 * np.pi : 33j, 0 : np.pi : 17j]
            ball = np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)
            axes.plot_surface(*ball, color=colour, linewidth=scaled(0.15), **SURFACE)
        else:
            sides = _faces(cone_matrix(name)[:, 1:])
            style = SURFACE | {"linewidth": scaled(0.6)}
            axes.add_collection3d(Poly3DCollection(sides, facecolor=colour, **style))
        for axis in "xyz":
            axes.set(**{f"{axis}lim": (-1.3, 1.3), f"{axis}ticks": (-1, 0, 1)})
        axes.set_box_aspect((1, 1, 1), zoom=0.82)
        axes.view_init(elev=CAMERA.elevation, azim=CAMERA.azimuth)
        axes.set_xlabel(r"$f_1/\mu_v$ [N]", labelpad=scaled(17) - OF_LABELS)
        axes.set_ylabel(r"$f_2/\mu_v$ [N]", labelpad=scaled(17) - OF_LABELS)
        axes.set_zlabel(r"$\tau_n/\mu_\omega$ [N]", labelpad=scaled(14) - OF_LABELS)
        axes.tick_params(pad=scaled(5) - OF_TICKS)
        axes.set_title(name)
    return page


def _faces(points: Array) -> list[Array]:
    """Faces of the convex hull, each with its corners in order, shapes (corners, 3)."""
    faces = []
    for plane in np.unique(ConvexHull(points).equations.round(SAME_PLANE), axis=0):
        corners = points[np.isclose(points @ plane[:3], -plane[3])]
        along = np.linalg.svd(plane[None, :3])[2][1:]  # two directions in the plane
        faces.append(corners[ConvexHull(corners @ along.T).vertices])
    return faces
