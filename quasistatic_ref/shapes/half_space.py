"""The half-space."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import dot, length
from quasistatic_ref.shapes.frozen import finite_number, freeze_array
from quasistatic_ref.shapes.shape import Shape


@dataclass(frozen=True, eq=False)
class HalfSpace(Shape):
    """The solid {x : normal'x <= offset}; the normal points out of it.

    Parameters
    ----------
    normal : ndarray, shape (3,)
        Any length but zero; stored with length one, the offset divided by the same length,
        so that the solid is the one that was written.
    offset : float
        Signed distance of the surface from the origin [m].

    Examples
    --------
    >>> phi, n = qr.HalfSpace((0, 0, 1), 0.0).signed_distance(np.array([[5, 0, -0.01]]))
    >>> phi  # [m]
    array([-0.01])
    """

    kind = "halfspace"

    normal: Array
    offset: float

    if TYPE_CHECKING:  # what is made of lists, too

        def __init__(self, normal: ArrayLike, offset: float) -> None: ...

    def __post_init__(self) -> None:
        freeze_array(self, "normal", (3,))
        offset = finite_number(self.offset, "offset")
        size = length(self.normal)
        if not (size > 0 and np.isfinite(offset / size)):
            raise ModelError("must not be zero", field="normal", value=self.normal.tolist())
        unit = self.normal / size
        unit.setflags(write=False)
        object.__setattr__(self, "normal", unit)
        object.__setattr__(self, "offset", offset / size)

    @cached_property
    def extent(self) -> float:
        """Extent of the half-space, which is infinite [m]."""
        return np.inf

    def signed_distance(self, points: Array) -> tuple[Array, Array]:
        """Height of `points`, shape (N, 3) [m], above the plane, and its normal."""
        phi = dot(points, self.normal) - self.offset
        normal = np.empty(points.shape)
        normal[:] = self.normal
        return phi, normal

    def faces(self, points: Array) -> tuple[Array, Array]:
        """Heights of `points`, shape (N, 3) [m], above the boundary plane, and normals."""
        phi, normal = self.signed_distance(points)
        return phi[:, None], normal[:, None]

    @property
    def sizes(self) -> dict[str, Any]:
        """The half-space's normal [-] and offset [m], by their names in files."""
        return {"normal": self.normal, "offset": self.offset}

    def words(self) -> str:
        """Kind, normal [-] and offset [m]."""
        x, y, z = self.normal + 0.0
        return f"half-space below ({x:g}, {y:g}, {z:g}) . x = {self.offset:g} m"
