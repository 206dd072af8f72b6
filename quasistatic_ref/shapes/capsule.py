"""The capsule."""

from functools import cached_property

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.revolved import Revolved
from quasistatic_ref.shapes.rounded import Rounded


class Capsule(Revolved, Rounded):
    """All points within radius [m] of a segment of its local z axis, |z| <= half_length [m].

    half_length is that of the segment, as in URDF and coal: the caps lie beyond it.

    Examples
    --------
    >>> phi, n = qr.Capsule(0.02, half_length=0.05).signed_distance(np.array([[0, 0, 0.08]]))
    >>> phi.round(12)  # [m]
    array([0.01])
    """

    kind = "capsule"

    @cached_property
    def core(self) -> tuple[Array, float]:
        """The capsule's segment, as half extents of shape (3,) [m], and its radius [m]."""
        return np.array([0.0, 0.0, self.half_length]), self.radius

    def corners(self, towards: Array) -> tuple[Array, float]:
        """Centres of the caps, shape (2, 3) [m], and the radius, for every `towards` [-]."""
        return np.array([[0, 0, -self.half_length], [0, 0, self.half_length]]), self.radius
