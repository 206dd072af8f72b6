"""The sphere."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.frozen import positive_length
from quasistatic_ref.shapes.rounded import Rounded


@dataclass(frozen=True, eq=False)
class Sphere(Rounded):
    """A ball of the given radius [m] about the origin of its frame.

    Examples
    --------
    >>> phi, n = qr.Sphere(0.05).signed_distance(np.array([[0, 0, 0.06]]))
    >>> phi.round(12)  # [m]
    array([0.01])
    """

    kind = "sphere"

    radius: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", positive_length(self.radius, "radius"))

    @cached_property
    def core(self) -> tuple[Array, float]:
        """The sphere's centre, as half extents of shape (3,) [m], and its radius [m]."""
        return np.array([0.0, 0.0, 0.0]), self.radius

    @property
    def sizes(self) -> dict[str, Any]:
        """The radius by its name in files [m]."""
        return {"radius": self.radius}
