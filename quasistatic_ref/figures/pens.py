"""Pens: world points drawn in millimetres, as a camera sees them or in three dimensions."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.patches import Polygon
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from scipy.spatial import ConvexHull, QhullError

from quasistatic_ref.figures.legible import DRAWING
from quasistatic_ref.figures.moments import Moment
from quasistatic_ref.figures.scene import CLOUD, CONTACT, SOLID, Camera, draw_shapes
from quasistatic_ref.figures.style import scaled
from quasistatic_ref.figures.surfaces import faces, patch, surface_points
from quasistatic_ref.model.shapes import HalfSpace, PointCloud
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.step.data import Array

PLANES: Final = {"xy": Camera(-90, 90), "xz": Camera(-90, 0), "yz": Camera(0, 0)}
"""Views along an axis of the world, named by what is to the right and what is up."""

CONE_FACE, CONE_EDGE = "#E69F00", "#8a5f00"
FLOOR = "0.93"
MILLI = 1e3


class Pen2D:
    """Draws world points as an orthographic camera sees them [mm]."""

    def __init__(self, axes: Any, camera: Camera) -> None:
        self.axes, self.camera = axes, camera

    def seen(self, points: Array) -> Array:
        """Points [m] on the page [mm], shape (N, 2)."""
        return MILLI * self.camera.seen(np.atleast_2d(points))[:, :2]

    def bodies(self, of: Moment, centre: Array, half: float) -> None:
        """Everything that is solid, clouds, and patches of half-spaces.

        What is shown lies within `half` [m] of the `centre`, shape (3,) [m].
        """
        for placed in of.shapes:
            if isinstance(placed.shape, HalfSpace):
                self._floor(patch(placed.shape, centre, 3 * half))
        bounded = [p for p in of.shapes if not isinstance(p.shape, HalfSpace)]
        poses = Kinematics(of.R, of.t_links, np.zeros((0, 6, 0)))
        draw_shapes(self.axes, self.camera, bounded, poses, MILLI)

    def _floor(self, corners: Array) -> None:
        outline = self.seen(corners)
        flat = np.linalg.svd(outline - outline.mean(axis=0))[1][-1] < 1e-6 * np.ptp(outline)
        if flat:  # seen from its side
            ends = outline[[np.lexsort(outline.T)[0], np.lexsort(outline.T)[-1]]]
            self.axes.plot(
                *ends.T, color="0.5", linewidth=1.4, linestyle="-", zorder=0.5, gid=DRAWING
            )
        else:
            style: dict[str, Any] = {"facecolor": FLOOR, "edgecolor": "0.6", "linewidth": 0.6}
            self.axes.add_patch(Polygon(outline, zorder=0, **style))

    def dot(self, point: Array, bears: bool) -> None:
        """A contact point, shape (3,) [m], filled where it bears load."""
        x, y = self.seen(point)[0]
        self.axes.plot(
            x, y, marker="o", linestyle="", color="black", markersize=scaled(4 if bears else 2.5),
            markerfacecolor=CONTACT if bears else "white", markeredgewidth=0.6, zorder=9,
            gid=DRAWING,
        )  # fmt: skip

    def line(self, points: Array, colour: str, dashes: str, width: float) -> None:
        """A line through points [m]."""
        self.axes.plot(
            *self.seen(points).T, color=colour, linestyle=dashes, lw=scaled(width), zorder=7,
            gid=DRAWING,
        )  # fmt: skip

    def hull(self, points: Array) -> None:
        """The convex hull of points [m], as a friction cone is drawn."""
        outline = self.seen(points)
        try:
            outline = outline[ConvexHull(outline).vertices]
        except QhullError:  # seen edge on
            return
        style: dict[str, Any] = {
            "facecolor": CONE_FACE,
            "edgecolor": CONE_EDGE,
            "linewidth": 0.6,
            "alpha": 0.35,
        }
        self.axes.add_patch(Polygon(outline, zorder=6, **style))

    def arrow(self, start: Array, along: Array) -> None:
        """A force that starts at a point: `start` and `along`, shape (3,) [m]."""
        (x, y), (u, v) = self.seen(start)[0], self.seen(along)[0]
        self.axes.annotate(
            "", (x + u, y + v), xytext=(x, y), annotation_clip=False, zorder=8,
            arrowprops={"arrowstyle": "-|>", "color": CONTACT, "linewidth": scaled(1.6),
                        "shrinkA": 0, "shrinkB": 0, "mutation_scale": scaled(8)},
        )  # fmt: skip

    def finish(self, box: Array, view: str | Camera) -> None:
        """Limits of a box, its corners of shape (2, 3) [m]; labels and view."""
        corners = self.seen(np.array(np.meshgrid(*box.T)).reshape(3, -1).T)
        (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
        self.axes.set(xlim=(left, right), ylim=(low, high), aspect="equal")
        self.axes.grid(visible=False)
        if isinstance(view, str):
            self.axes.set(xlabel=f"{view[0]} [mm]", ylabel=f"{view[1]} [mm]")
        else:
            self.axes.set(xticks=[], yticks=[])
            self.axes.spines[:].set_visible(False)


class Pen3D:
    """Draws world points in matplotlib's 3D axes [mm]."""

    def __init__(self, axes: Any) -> None:
        self.axes = axes

    def bodies(self, of: Moment, centre: Array, half: float) -> None:
        """Everything that is solid, clouds, and patches of half-spaces.

        What is shown lies within `half` [m] of the `centre`, shape (3,) [m].
        """
        for placed in of.shapes:
            if isinstance(placed.shape, HalfSpace):
                corners = MILLI * patch(placed.shape, centre, half)
                self._polygons([corners], FLOOR, "0.6", 0.5)
            elif isinstance(placed.shape, PointCloud):
                points = MILLI * of.world(placed, placed.shape.points)
                self.axes.scatter(*points.T, s=1.5, c=CLOUD, linewidths=0)
            else:
                points = of.world(placed, surface_points(placed, around=24, up=9))
                self._polygons([MILLI * face for face in faces(points)], SOLID, "0.2", 0.3)

    def _polygons(self, polygons: list[Array], face: str, edge: str, alpha: float) -> None:
        style = {"facecolor": face, "edgecolor": edge, "linewidth": 0.4, "alpha": alpha}
        self.axes.add_collection3d(Poly3DCollection(polygons, **style))

    def dot(self, point: Array, bears: bool) -> None:
        """A contact point, shape (3,) [m], filled where it bears load."""
        self.axes.plot(
            *(MILLI * point)[:, None], marker="o", linestyle="", color="black",
            markersize=scaled(4 if bears else 2.5), gid=DRAWING,
            markerfacecolor=CONTACT if bears else "white", markeredgewidth=0.6,
        )  # fmt: skip

    def line(self, points: Array, colour: str, dashes: str, width: float) -> None:
        """A line through points [m]."""
        self.axes.plot(
            *(MILLI * points).T, color=colour, linestyle=dashes, lw=scaled(width), gid=DRAWING
        )

    def hull(self, points: Array) -> None:
        """The convex hull of points [m], as a friction cone is drawn."""
        try:
            self._polygons([MILLI * face for face in faces(points)], CONE_FACE, CONE_EDGE, 0.3)
        except QhullError:  # so little force that it has no volume
            return

    def arrow(self, start: Array, along: Array) -> None:
        """A force that starts at a point: `start` and `along`, shape (3,) [m]."""
        self.axes.quiver(
            *(MILLI * start), *(MILLI * along), color=CONTACT, linewidth=scaled(1.6),
            arrow_length_ratio=0.2,
        )  # fmt: skip

    def finish(self, box: Array, view: str | Camera) -> None:
        """Limits of a box, its corners of shape (2, 3) [m]; labels and view."""
        centre, half = box.mean(axis=0), np.ptp(box, axis=0).max() / 2
        low, high = MILLI * (centre - half), MILLI * (centre + half)
        for k, name in enumerate("xyz"):
            getattr(self.axes, f"set_{name}lim")(low[k], high[k])
            getattr(self.axes, f"set_{name}label")(f"{name} [mm]")
            getattr(self.axes, f"{name}axis").set_major_locator(MaxNLocator(4))
        self.axes.set_box_aspect((1, 1, 1))
        camera = view if isinstance(view, Camera) else Camera(-60, 20)
        self.axes.view_init(elev=camera.elevation, azim=camera.azimuth)
