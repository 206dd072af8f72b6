"""Measured pushes: what is predicted, and never used to identify anything."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.reality.pairs import Pair
from quasistatic_ref.lab.reality.tables import table_read
from quasistatic_ref.step.data import Array, Indices

COLUMNS: Mapping[str, str] = {
    "push": "[-] number of the push in its pair",
    "x0": "[m] origin of the object's frame before, world frame",
    "y0": "[m]",
    "theta0": "[rad] angle of the object's frame before",
    "x1": "[m] after",
    "y1": "[m]",
    "theta1": "[rad]",
    "tip_x0": "[m] centre of the finger at the start of its straight path",
    "tip_y0": "[m]",
    "tip_x1": "[m] at its end",
    "tip_y1": "[m]",
}
OTHERS: Mapping[str, str] = {
    "lcp_x1": "[m] the pose after that a published simulator predicts",
    "lcp_y1": "[m]",
    "lcp_theta1": "[rad]",
}


@dataclass(frozen=True, eq=False)
class Pushes:
    """The pushes of a pair.

    Parameters
    ----------
    number : ndarray of int, shape (n,)
    before, after : ndarray, shape (n, 3)
        Poses of the object's frame: x, y [m], angle [rad].
    path : ndarray, shape (n, 2, 2)
        Start and end of the finger's centre [m].
    published : ndarray, shape (n, 3), or None
        Poses after, by a published simulator [m, rad].
    """

    number: Indices
    before: Array
    after: Array
    path: Array
    published: Array | None

    def every(self, step: int) -> "Pushes":
        """Every so manyth push, from the first."""
        other = None if self.published is None else self.published[::step]
        arrays = self.before[::step], self.after[::step], self.path[::step]
        return Pushes(self.number[::step], *arrays, other)


def pushes_read(folder: Path, pairs: list[Pair]) -> dict[str, Pushes]:
    """The pushes of each pair from ``pushes.csv``.

    Raises
    ------
    InputError
        If the file is missing or not as it must be, or a pair has no pushes.
    """
    path = folder / "pushes.csv"
    table = table_read(path, COLUMNS, OTHERS)
    pushes = {}
    for pair in pairs:
        rows = table.rows(pair.name)
        if not rows.size:
            raise InputError("has no pushes", file=path, field=pair.name)
        number = table.numbers["push"][rows]
        if len(set(number.tolist())) < number.size or (number % 1).any():
            problem = "must be whole numbers, each once"
            raise InputError(problem, file=path, field=f"{pair.name}, push")
        tips = table.array(rows, "tip_x0", "tip_y0", "tip_x1", "tip_y1")
        pushes[pair.name] = Pushes(
            number.astype(np.int64),
            table.array(rows, "x0", "y0", "theta0"),
            table.array(rows, "x1", "y1", "theta1"),
            tips.reshape(-1, 2, 2),
            table.array(rows, *OTHERS) if all(name in table for name in OTHERS) else None,
        )
    return pushes
