"""The box."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.numbers.arrays import Array, read_only
from quasistatic_ref.shapes.frozen import freeze_array, positive_lengths, set_half
from quasistatic_ref.shapes.rounded import Rounded
from quasistatic_ref.shapes.shape import DIRECTIONS


@dataclass(frozen=True, eq=False, init=False)
class Box(Rounded):
    """A cuboid along the axes of its frame: |x_i| <= half_extents_i = size_i / 2, shape (3,) [m].

    It is made of its half extents or, as in files, of its `size`, shape (3,) [m].

    Examples
    --------
    >>> phi, n = qr.Box((0.01, 0.02, 0.03)).signed_distance(np.array([[0, 0, 0.05]]))
    >>> phi.round(12)  # [m]
    array([0.02])
    """

    kind = "box"

    half_extents: Array

    def __init__(
        self, half_extents: ArrayLike | None = None, *, size: ArrayLike | None = None
    ) -> None:
        set_half(self, "half_extents", half_extents, "size", size, positive_lengths)
        freeze_array(self, "half_extents", (3,))

    @cached_property
    def core(self) -> tuple[Array, float]:
        """The box as a core without a ball: half extents, shape (3,) [m], and radius 0 [m]."""
        return self.half_extents, 0.0

    def faces(self, points: Array) -> tuple[Array, Array]:
        """Heights of `points`, shape (N, 3) [m], above the six faces, and their normals."""
        heights = np.concatenate([points, -points], axis=1) - np.tile(self.half_extents, 2)
        return heights, np.broadcast_to(DIRECTIONS, (len(points), 6, 3))

    def corners(self, towards: Array) -> tuple[Array, float]:
        """The box's vertices, shape (8, 3) [m], whatever the direction `towards` [-] is."""
        return self._vertices, 0.0

    @cached_property
    def _vertices(self) -> Array:
        bits = (np.arange(8)[:, None] >> np.array([0, 1, 2])) & 1
        return read_only((2 * bits - 1) * self.half_extents)

    @property
    def edge_count(self) -> int:
        """Number of edges of one face."""
        return 4

    @property
    def sizes(self) -> dict[str, Any]:
        """Edge lengths of the box [m], by their name in files."""
        return {"size": 2 * self.half_extents}
