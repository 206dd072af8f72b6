"""Bodies, clouds and contacts as an orthographic camera sees them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from quasistatic_ref.model.shapes import Box, Capsule, Cylinder, PlacedShape, PointCloud, Sphere
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


def surface_points(placed: PlacedShape) -> Array:
    """A cloud's points, or points whose hull looks like the shape; its own frame, (N, 3) [m]."""
    shape = placed.shape
    if isinstance(shape, PointCloud):
        return shape.points
    if isinstance(shape, Box):
        signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
        return np.asarray(signs * shape.half_extents)
    azimuth, height = np.meshgrid(np.linspace(0, 2 * np.pi, 48), np.linspace(-1, 1, 25))
    if isinstance(shape, Cylinder):
        ring = np.stack([np.cos(azimuth), np.sin(azimuth), np.sign(height)], axis=-1)
        return np.asarray(ring.reshape(-1, 3) * [shape.radius, shape.radius, shape.half_length])
    if isinstance(shape, Sphere | Capsule):
        r = np.sqrt(1 - height**2)
        ball = np.stack([r * np.cos(azimuth), r * np.sin(azimuth), height], axis=-1)
        points = shape.radius * ball.reshape(-1, 3)
        if isinstance(shape, Capsule):
            end = np.array([0, 0, shape.half_length])
            points = np.concatenate([points + end, points - end])
        return np.asarray(points)
    return np.zeros((0, 3))


def draw_shapes(
    axes: Axes, camera: Camera, shapes: Iterable[PlacedShape], kinematics: Kinematics
) -> None:
    """Draw shapes from the farthest to the nearest."""
    ordered = sorted(shapes, key=lambda placed: _nearness(camera, placed, kinematics))
    for layer, placed in enumerate(ordered):
        _draw_shape(axes, camera, placed, kinematics, 1 + layer / len(ordered))


def _draw_shape(
    axes: Axes, camera: Camera, placed: PlacedShape, kinematics: Kinematics, zorder: float
) -> None:
    """Draw one shape: a cloud as dots, shaded by depth; a solid as its outline, filled."""
    R, t = kinematics.R[placed.link], kinematics.t[placed.link]
    cloud = isinstance(placed.shape, PointCloud)
    local = surface_points(placed)
    if not len(local):
        return
    world = (local @ placed.R.T + placed.t) @ R.T + t
    seen = camera.seen(world)
    if cloud:
        order = seen[:, 2].argsort()
        x, y, depth = seen[order].T
        near = (depth - depth[0]) / max(float(depth[-1] - depth[0]), 1e-12)
        size, opacity = 1.2 + 1.6 * near, 0.25 + 0.6 * near
        axes.scatter(x, y, s=size, c=CLOUD, alpha=opacity, linewidths=0, zorder=zorder)
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
    for chosen, size, colour in ((~bearing, 8, "white"), (bearing, 20, CONTACT)):
        x, y = seen[chosen, 0], seen[chosen, 1]
        axes.scatter(x, y, s=size, c=colour, linewidths=0.8, edgecolors="black", zorder=9)
