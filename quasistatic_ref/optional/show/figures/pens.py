"""A pen that draws world points in millimetres, as a camera sees them."""

from contextlib import suppress
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.patches import Polygon
from scipy.spatial import ConvexHull, QhullError

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures.camera import Camera
from quasistatic_ref.optional.show.figures.looks import (
    CONE_EDGE,
    CONE_FACE,
    FLOOR,
    FORCE,
    OPACITY,
    by_depth,
    force_arrow,
    lit,
)
from quasistatic_ref.optional.show.figures.moments import Moment
from quasistatic_ref.optional.show.figures.style import scaled
from quasistatic_ref.optional.show.figures.surfaces import patch, surface_points
from quasistatic_ref.shapes.placed_shape import HalfSpace, PlacedShape, PointCloud

PLANES: Final = {"xy": Camera(-90, 90), "xz": Camera(-90, 0), "yz": Camera(0, 0)}
"""Views along an axis of the world, named by what is to the right and what is up."""

EDGE_ON = 1e-6
"""Cosine of the angle between a view and a normal, below which a plane is seen as a line [-]."""

MILLI = 1e3
DOT = 5.0
"""Size of a cloud's point on paper [pt^2]."""


class Pen:
    """Draws world points on matplotlib's axes [mm], as an orthographic camera sees them.

    Parameters
    ----------
    axes : Axes
    camera : Camera
    """

    def __init__(self, axes: Axes, camera: Camera) -> None:
        self.axes = axes
        self.camera = camera

    def seen(self, points: Array) -> Array:
        """Coordinates of points to the right and upwards [mm], shape (N, 2)."""
        return MILLI * self.camera.seen(np.atleast_2d(points))[:, :2]

    def dot(self, point: Array, bears: bool) -> None:
        """Draw a contact point, shape (3,) [m], filled if the contact bears load."""
        self.axes.plot(
            *self.seen(point).T, marker="o", linestyle="", color="black", markeredgewidth=0.6,
            markersize=scaled(3.5 if bears else 2.2), markerfacecolor=FORCE if bears else "white",
            zorder=9 + bears,
        )  # fmt: skip

    def line(self, points: Array, colour: str, dashes: str, width: float) -> None:
        """Draw a line through points [m]."""
        self.axes.plot(
            *self.seen(points).T, color=colour, linestyle=dashes, linewidth=scaled(width),
            zorder=7,
        )  # fmt: skip

    def bodies(self, of: Moment, centre: Array, half: float) -> None:
        """Draw the bodies of a moment from the farthest to the nearest, half-spaces first.

        Parameters
        ----------
        of : Moment
        centre : ndarray, shape (3,)
            Of what is drawn of a half-space [m].
        half : float
            Half the length of its edges [m].
        """
        bounded = []
        for placed in of.shapes:
            if isinstance(placed.shape, HalfSpace):
                self._floor(placed.shape, patch(placed.shape, centre, 3 * half))
            else:
                nearness = self.camera.seen(of.world(placed, np.zeros((1, 3))))[0, 2]
                bounded.append((nearness, placed))
        bounded.sort(key=lambda pair: float(pair[0]))
        for layer, (_, placed) in enumerate(bounded):
            points = self.camera.seen(of.world(placed, surface_points(placed.shape)))
            self._body(placed, points, of.colours[placed.link], 1 + layer / len(bounded))

    def _body(self, placed: PlacedShape, seen: Array, colour: str, zorder: float) -> None:
        """Draw a cloud as dots, paler by depth; a solid as its faces, lit, and its outline."""
        if not isinstance(placed.shape, PointCloud):
            hull = ConvexHull(seen)
            front = hull.equations[:, 2] > 0
            shades = lit(colour, hull.equations[front, :3])
            opacity = OPACITY.get(colour, 1.0)
            faces = MILLI * seen[hull.simplices[front], :2]
            self.axes.add_collection(PolyCollection(
                list(faces), facecolors=shades, edgecolors=shades,
                linewidths=0.4 if opacity == 1 else 0, alpha=opacity, zorder=zorder,
            ))  # fmt: skip
            outline = MILLI * seen[ConvexHull(seen[:, :2]).vertices, :2]
            self._fill(outline, "none", "black", linewidth=0.7, zorder=zorder)
            return
        x, y, depth = seen[seen[:, 2].argsort()].T
        self.axes.scatter(
            MILLI * x, MILLI * y, s=DOT * scaled(1) ** 2, c=by_depth(colour, depth), linewidths=0,
            zorder=zorder, rasterized=True,
        )  # fmt: skip

    def _floor(self, floor: HalfSpace, corners: Array) -> None:
        """Draw a half-space as a square of its surface, or as a line if seen edge on."""
        from_the_side = abs(self.camera.axes()[2] @ floor.normal) < EDGE_ON
        edge, linewidth = ("0.5", 1.4) if from_the_side else ("0.6", 0.6)
        self._fill(self.seen(corners), FLOOR, edge, linewidth, zorder=0.5)

    def _fill(
        self, outline: Array, face: str, edge: str, linewidth: float = 0.6, **style: Any
    ) -> None:
        self.axes.add_patch(
            Polygon(outline, facecolor=face, edgecolor=edge, linewidth=linewidth, **style)
        )

    def hull(self, points: Array) -> None:
        """Draw the filled outline of the hull of points, unless it is seen edge on."""
        outline = self.seen(points)
        with suppress(QhullError):
            outline = outline[ConvexHull(outline).vertices]
            self._fill(outline, CONE_FACE, CONE_EDGE, alpha=0.35, zorder=6)

    def arrow(self, start: Array, along: Array) -> None:
        """Draw the arrow of a force.

        Parameters
        ----------
        start, along : ndarray, shape (3,)
            Its tail, and the way from there to its head [m].
        """
        (x, y), (u, v) = self.seen(np.stack([start, start + along]))
        force_arrow(self.axes, (x, y), (u, v))

    def finish(self, box: Array, view: str | Camera) -> None:
        """Set limits and labels of the axes: coordinates only along an axis of the world.

        Parameters
        ----------
        box : ndarray, shape (2, 3)
            Least and largest coordinates of what is drawn [m].
        view : str or Camera
        """
        corners = self.seen(np.array(np.meshgrid(*box.T)).reshape(3, -1).T)
        left, low = corners.min(axis=0)
        right, high = corners.max(axis=0)
        self.axes.set(xlim=(left, right), ylim=(low, high), aspect="equal")
        self.axes.grid(visible=False)
        if isinstance(view, str):
            self.axes.set(xlabel=f"{view[0]} [mm]", ylabel=f"{view[1]} [mm]")
        else:
            self.axes.set(xticks=[], yticks=[])
            self.axes.spines[:].set_visible(False)
