"""Measured loads and the motions that they caused: what friction is identified from."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quasistatic_ref.lab.reality.outline import rotation
from quasistatic_ref.lab.reality.pairs import Pair
from quasistatic_ref.lab.reality.tables import table_read
from quasistatic_ref.step.data import Array

COLUMNS: Mapping[str, str] = {
    "f_x": "[N] force of the pusher on the object, object frame",
    "f_y": "[N]",
    "tau": "[N m] its torque about the origin of the frame",
    "v_x": "[m, up to scale] displacement of the origin, object frame",
    "v_y": "[m, up to scale]",
    "omega": "[rad, up to scale] turn",
}


@dataclass(frozen=True, eq=False)
class Loads:
    """Loads on an object and its motions, about its centre of mass.

    Parameters
    ----------
    wrench : ndarray, shape (n, 3)
        Force [N] and torque [N m].
    twist : ndarray, shape (n, 3)
        Velocity and turn, up to their length [m, rad].
    """

    wrench: Array
    twist: Array

    def about(self, centre: Array) -> "Loads":
        """The same about a `centre`, shape (2,) [m]."""
        wrench = self.wrench.copy()
        twist = self.twist.copy()
        x, y = centre
        wrench[:, 2] -= x * wrench[:, 1] - y * wrench[:, 0]
        twist[:, 0] -= y * twist[:, 2]
        twist[:, 1] += x * twist[:, 2]
        return Loads(wrench, twist)

    def turned(self, angle: float) -> "Loads":
        """The same in axes that are turned by an angle [rad]."""
        R = np.eye(3)
        R[:2, :2] = rotation(-angle)
        return Loads(self.wrench @ R.T, self.twist @ R.T)


def loads_read(folder: Path, pairs: list[Pair]) -> dict[str, Loads]:
    """The loads of each pair from ``loads.csv``, about the centre of the outline.

    A pair without loads has none, and its friction cannot be identified.

    Raises
    ------
    InputError
        If the file is missing or not as it must be.
    """
    table = table_read(folder / "loads.csv", COLUMNS, {})
    loads = {}
    for pair in pairs:
        rows = table.rows(pair.name)
        wrench = table.array(rows, "f_x", "f_y", "tau")
        twist = table.array(rows, "v_x", "v_y", "omega")
        moving = np.linalg.norm(twist, axis=1) * np.linalg.norm(wrench, axis=1) > 0
        loads[pair.name] = Loads(wrench[moving], twist[moving]).about(pair.outline.centre)
    return loads
