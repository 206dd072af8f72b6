"""Pairs at distance 0 whose normal is the difference of their closest points."""

from dataclasses import replace
from typing import Final

from flint import fmpq

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.distances.shapes import Placed
from quasistatic_ref.lab.vectors.distances.solid_pair import pair_witness
from quasistatic_ref.lab.vectors.exact.algebra import IDENTITY, along
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.whole.grid import working
from quasistatic_ref.lab.vectors.whole.nearby import Touching, candidates
from quasistatic_ref.lab.vectors.whole.world import world

APART: Final = fmpq(1, 1 << 60)
"""Solids that are parted by a translation of 9e-19 m touch; deeper ones are in penetration."""


def touching_pairs(case: Json) -> list[str]:
    """Names of the pairs of solids that touch; those in penetration are none.

    Parameters
    ----------
    case : dict
        Input of the layer ``step``.
    """
    at, found = world(case), []
    for k, pair in enumerate(case["pairs"]):
        try:
            candidates(at, k)
        except Touching:
            alpha, beta = (at.shape(pair[side]) for side in ("alpha", "beta"))
            for sign in (1, -1):
                for axis in IDENTITY:
                    apart = replace(beta, t=along(beta.t, axis, sign * APART))
                    if pair["name"] not in found and _are_apart(alpha, apart):
                        found.append(pair["name"])
    return found


def _are_apart(alpha: Placed, beta: Placed) -> bool:
    try:
        with working():
            pair_witness(alpha, beta)
    except InputError:
        return False
    return True
