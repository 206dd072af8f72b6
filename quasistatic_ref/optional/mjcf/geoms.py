"""MuJoCo's types of joints and geoms; which geoms touch, are drawn, and how far each reaches."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.step.arrays import Array, Mask

if TYPE_CHECKING:
    from mujoco import MjModel

FREE, BALL, SLIDE, HINGE = range(4)
"""Types of joints, as MuJoCo numbers them."""
GEOMS = ("plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "sdf")
"""Types of geoms, as MuJoCo numbers them."""
GREY = (0.5, 0.5, 0.5, 1.0)
"""The colour of a geom that is given none."""
HIDDEN = 3
"""The first group of geoms that MuJoCo does not draw unless it is asked to."""


def touching(model: MjModel) -> Mask:
    """Whether each geom touches others and is not a plane or field of the world, shape (ngeom,)."""
    touches = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
    endless = np.isin(model.geom_type, (0, 1)) & (model.geom_bodyid == 0)
    return np.asarray(touches & ~endless)


def drawn(model: MjModel, g: int) -> bool:
    """Whether MuJoCo draws a geom."""
    return bool(model.geom_group[g] < HIDDEN and rgba(model, g)[3])


def rgba(model: MjModel, g: int) -> Array:
    """A geom's colour as MuJoCo draws it, shape (4,): its own, where it has no material or one."""
    own = model.geom_rgba[g]
    material = model.geom_matid[g]
    return np.asarray(own if material < 0 or np.any(own != GREY) else model.mat_rgba[material])


def geom_support(model: MjModel, g: int, directions: Array) -> Array:
    """How far a geom reaches along directions of its own frame, (N, 3) [-], shape (N,) [m].

    From MuJoCo's numbers alone, for the shapes that a URDF has a name for.
    """
    kind = GEOMS[model.geom_type[g]]
    radius, half, _ = model.geom_size[g]
    along = np.abs(directions[:, 2])
    across = np.hypot(directions[:, 0], directions[:, 1])
    if kind == "sphere":
        return np.full(len(directions), radius)
    if kind == "capsule":
        return np.asarray(radius + half * along)
    if kind == "cylinder":
        return np.asarray(radius * across + half * along)
    if kind == "box":
        return np.asarray(np.abs(directions) @ model.geom_size[g])
    mesh = model.mesh(model.geom_dataid[g])
    last = int(mesh.vertadr[0] + mesh.vertnum[0])
    vertices = model.mesh_vert[int(mesh.vertadr[0]) : last].astype(np.float64)
    return np.asarray((directions @ vertices.T).max(axis=1))
