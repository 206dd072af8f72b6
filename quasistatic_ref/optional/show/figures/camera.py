"""An orthographic camera."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from quasistatic_ref.numbers.arrays import Array


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
        turn = Rotation.from_euler("ZY", [self.azimuth, -self.elevation], degrees=True)
        towards, right, up = turn.as_matrix().T
        return np.array([right, up, towards])

    def seen(self, points: Array) -> Array:
        """Right, up and nearness of world points, shape (N, 3) [m]."""
        return np.asarray(points @ self.axes().T)
