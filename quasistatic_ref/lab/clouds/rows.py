"""The committed rows of the study of clouds."""

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from quasistatic_ref.lab.clouds.study import NONE, TORSION, grid
from quasistatic_ref.lab.folders import clouds_file
from quasistatic_ref.lab.log import Record, records_read
from quasistatic_ref.step.data import Array


@cache
def rows() -> tuple[Record, ...]:
    """Every grasp that was made, in the order of the grid."""
    return tuple(records_read(clouds_file())[1:])


def rows_with(**fields: Any) -> list[Record]:
    """Rows with these values of their fields.

    Parameters
    ----------
    fields : object
        ``sampling="random"``, ``count=992``, ``change="none"``, ...
    """
    return [row for row in rows() if all(row[name] == value for name, value in fields.items())]


def with_torsion(row: Record) -> bool:
    """Whether the fingers have a mu_omega."""
    return bool(row["mu_omega"] > 0.0)


def is_held(row: Record) -> bool:
    """Whether the bunny was lifted and did not turn."""
    limits = grid()["held"]
    rises = row["lift"] >= limits["lift"]
    turns = row["rotation"] <= limits["rotation"]
    return bool(not row["failed"] and rises and turns)


def margin(row: Record) -> float:
    """mu_omega over the one that is needed [-]; 0 where none would do."""
    if row.get("needed") is None:
        return 0.0
    return float((row["mu_omega"] + row["spread"]) / row["needed"])


def rotations(records: Sequence[Record]) -> Array:
    """Largest rotation of each during the lift [deg], shape (N,)."""
    return np.array([row["rotation"] for row in records])


def rotations_by_case() -> dict[str, Array]:
    """Rotations of all clouds of 992 points in the scene as it is [deg], by its two cases.

    Returns
    -------
    dict of str to ndarray, shape (120,)
    """
    records = rows_with(count=992, change=NONE)
    return {
        case: rotations([row for row in records if with_torsion(row) == bool(mu_omega)])
        for case, mu_omega in (("with torsion", TORSION), ("without torsion", 0.0))
    }
