"""Bodies, clouds and contacts as an orthographic camera sees them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from quasistatic_ref.figures.style import scaled
from quasistatic_ref.figures.surfaces import surface_points
from quasistatic_ref.model.shapes import PlacedShape, PointCloud
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.step.data import Array

CLOUD = "#0072B2"
SOLID = "0.55"
CONTACT = "#D55E00"


@dataclass(frozen=True)
class Camera:
    """An orthographic camera that looks at the origin.

    Parameters
    ----------
    azimuth : float
        Angle of the camera about z from the x axis [deg].
    elevation : float
        Angle of the camera above the horizon [deg].
    """

    azimuth: float
    elevation: float

    def axes(self) -> Array:
        """Rows: to the right, upwards, towards the camera; shape (3, 3), world frame."""
        a, e = np.radians([self.azimuth, self.elevation])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        return np.array([right, np.cross(towards, right), towards])

    def seen(self, points: Array) -> Array:
        """Right, up and nearness of world points, shape (N, 3) [m]."""
        return np.asarray(points @ self.axes().T)


def draw_shapes(
    axes: Axes,
    camera: Camera,
    shapes: Iterable[PlacedShape],
    kinematics: Kinematics,
    unit: float = 1.0,
) -> None:
    """Draw shapes from the farthest to the nearest, with `unit` of the axes to a metre [1/m]."""
    ordered = sorted(shapes, key=lambda placed: _nearness(camera, placed, kinematics))
    for layer, placed in enumerate(ordered):
        R, t = kinematics.R[placed.link], kinematics.t[placed.link]
        local = surface_points(placed)
        if len(local):
            seen = unit * camera.seen((local @ placed.R.T + placed.t) @ R.T + t)
            _draw_shape(axes, placed, seen, 1 + layer / len(ordered))


def _draw_shape(axes: Axes, placed: PlacedShape, seen: Array, zorder: float) -> None:
    """Draw one shape: a cloud as dots, shaded by depth; a solid as its outline, filled."""
    if isinstance(placed.shape, PointCloud):
        order = seen[:, 2].argsort()
        x, y, depth = seen[order].T
        near = (depth - depth[0]) / max(float(depth[-1] - depth[0]), 1e-12)
        size, opacity = 0.8 + 1.1 * near, 0.25 + 0.6 * near
        axes.scatter(
            x, y, s=scaled(1) ** 2 * size, c=CLOUD, alpha=opacity, linewidths=0, zorder=zorder
        )
        return
    outline = seen[ConvexHull(seen[:, :2]).vertices, :2]
    axes.add_patch(
        Polygon(
            outline, facecolor=SOLID, edgecolor="black", linewidth=0.7, alpha=0.6, zorder=zorder
        )
    )


def _nearness(camera: Camera, placed: PlacedShape, kinematics: Kinematics) -> float:
    """How near the camera a shape's origin is [m]; the nearer is drawn the later."""
    R, t = kinematics.R[placed.link], kinematics.t[placed.link]
    return float(camera.seen((R @ placed.t + t)[None])[0, 2])


def draw_floor(axes: Axes, camera: Camera, half_width: float) -> None:
    """A square patch of the plane z = 0."""
    corners = half_width * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    outline = camera.seen(corners)[:, :2]
    axes.add_patch(Polygon(outline, facecolor="0.93", edgecolor="0.6", linewidth=0.6, zorder=0))


def draw_contacts(axes: Axes, camera: Camera, points: Array, bearing: NDArray[np.bool_]) -> None:
    """Contact points, filled where they bear load.

    Parameters
    ----------
    axes : Axes
    camera : Camera
    points : ndarray, shape (n_c, 3)
        World frame [m].
    bearing : ndarray of bool, shape (n_c,)
    """
    seen = camera.seen(points)
    for chosen, size, colour in ((~bearing, 5, "white"), (bearing, 13, CONTACT)):
        x, y = seen[chosen, 0], seen[chosen, 1]
        axes.scatter(
            x, y, s=scaled(1) ** 2 * size, c=colour, linewidths=0.6, edgecolors="black", zorder=9
        )
