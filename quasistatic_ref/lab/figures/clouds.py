"""The committed study of clouds: the grasp with other clouds of the same bunny, a row each.

Its rows were measured once: which cloud, what is not as in the scene, and what became of the grasp
(largest rotation [deg] and rise [mm] in the lift). Of the closed grip a row has the squeeze of a
finger [N], the distance of the centre of mass from the line of the loads [m], the loaded points,
and the mu_omega that these have by mu_v alone (R15), and that is needed (R14) [m].
"""

import json
from functools import cache
from typing import Any

import numpy as np

from quasistatic_ref.lab.folders import clouds_file
from quasistatic_ref.numbers.arrays import Array

Row = dict[str, Any]
TURNS = 1.0
"""A bunny is held that turns by no more during the lift [deg] ..."""
RISES = 30.0
"""... and rises by no less [mm]."""


@cache
def rows() -> tuple[Row, ...]:
    """All grasps of sampled clouds; ``change`` names what differs from the scene."""
    _, *lines = clouds_file().read_text("utf-8").splitlines()
    return tuple(json.loads(line) for line in lines)


def is_held(row: Row) -> bool:
    """Whether the bunny was lifted and did not turn."""
    return bool(row["lift"] >= RISES and row["rotation"] <= TURNS)


def margin(row: Row) -> float:
    """mu_omega over the one that is needed [-]; 0 where none would do."""
    if row.get("needed") is None:
        return 0.0
    return float((row["mu_omega"] + row["spread"]) / row["needed"])


def rotations_by_case() -> dict[str, Array]:
    """Rotations of all clouds of 992 points in the scene as it is [deg], by its two cases.

    Returns
    -------
    dict of str to ndarray, shape (120,)
    """
    some = [row for row in rows() if row["count"] == 992 and row["change"] == "none"]
    return {
        case: np.array([row["rotation"] for row in some if (row["mu_omega"] > 0) == torsion])
        for case, torsion in (("with torsion", True), ("without torsion", False))
    }
