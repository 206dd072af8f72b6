"""Pairs of solids that touch and have several normals there: a rim or a tip on an edge."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import product

from flint import fmpq

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.distances.shapes import Placed
from quasistatic_ref.lab.vectors.distances.solid_pair import pair_witness
from quasistatic_ref.lab.vectors.exact.precision import Vector, vector
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.unrounded.grid import on_grid, working_precision
from quasistatic_ref.lab.vectors.unrounded.nearby import Touching, candidates
from quasistatic_ref.lab.vectors.unrounded.world import world

APART = fmpq(1, 1 << 60)
"""Solids that are parted by a translation of 9e-19 m touch; deeper ones are in penetration."""
OTHER = fmpq(1, 1 << 20)
"""Normals of smooth surfaces turn by much less than that over 9e-19 m."""


def touching_pairs(case: Json) -> list[str]:
    """Names of the pairs of solids that touch and have several normals.

    Parameters
    ----------
    case : dict
        Input of the layer ``step``.
    """
    at = world(case)
    found = []
    for k, pair in enumerate(case["pairs"]):
        try:
            candidates(at, k)
        except Touching:
            normals = list(_normals(*(at.shape(pair[side]) for side in ("alpha", "beta"))))
            if any(abs(x - y) > OTHER for n in normals for x, y in zip(n, normals[0], strict=True)):
                found.append(pair["name"])
    return found


def _normals(alpha: Placed, beta: Placed) -> Iterator[Vector]:
    """Normals after each translation, by next to nothing, that parts two solids."""
    for way in product((-1, 0, 1), repeat=3):
        apart = replace(beta, t=beta.t + APART * vector(way))
        try:
            with working_precision():
                yield on_grid(pair_witness(alpha, apart).n)
        except InputError:
            continue
