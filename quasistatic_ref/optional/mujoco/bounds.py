"""Bounding balls of geoms that are smaller than the geoms: MuJoCo misses contacts by them."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.mujoco.mujoco_state import MujocoState
from quasistatic_ref.optional.mujoco.places import geom_kind

RADII: dict[str, Callable[[Array], float]] = {
    "SPHERE": lambda size: float(size[0]),
    "CAPSULE": lambda size: float(size[0] + size[1]),
    "CYLINDER": lambda size: float(np.hypot(size[0], size[1])),
    "BOX": lambda size: float(np.linalg.norm(size)),
    "ELLIPSOID": lambda size: float(size.max()),
}
"""Distance from the middle of a geom to its farthest point, by kind, from ``geom_size`` [m]."""
ROUNDED = 1e-9
"""Part of a radius that is rounding [-]."""


def stale(state: MujocoState) -> Iterator[str]:
    """Sentences on geoms that were enlarged after their model was compiled, without their bound."""
    model = state.model
    for g in range(model.ngeom):
        kind = geom_kind(state, g)
        if kind not in RADII:
            continue
        radius = RADII[kind](model.geom_size[g])
        bound = float(model.geom_rbound[g])
        if bound < (1 - ROUNDED) * radius:
            yield (
                f"{state.words('geom', g)} reaches {1e3 * radius:.4g} mm far and its geom_rbound "
                f"{1e3 * bound:.4g} mm, so that MuJoCo misses contacts; set geom_rbound and "
                "geom_aabb with geom_size, or compile the model again"
            )
