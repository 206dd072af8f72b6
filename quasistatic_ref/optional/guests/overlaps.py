"""Bodies that overlap in MuJoCo, by this package's distances."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.contact.distance import in_world
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.separations import gaps
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.solids.solid_pair import pair_and_gaps
from quasistatic_ref.errors import ContactError
from quasistatic_ref.optional.guests.mujoco_state import MujocoState
from quasistatic_ref.optional.guests.places import KINDS_OF_GEOMS, candidates, geom_kind, placed
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.tolerances import DEEP, PIERCES

if TYPE_CHECKING:
    pass


class Overlap(NamedTuple):
    """Two geoms in each other.

    Parameters
    ----------
    name : str
        Of the two geoms.
    geoms : tuple of int
        By their numbers.
    depth : float
        [m].
    """

    name: str
    geoms: tuple[int, int]
    depth: float


def unlisted(state: MujocoState) -> Iterator[Overlap]:
    """Geoms that are deep in each other, and that MuJoCo lists no contact of."""
    listed = {tuple(sorted(touch.geom.tolist())) for touch in state.data.contact}
    for overlap in overlaps(state):
        if overlap.geoms not in listed and overlap.depth > DEEP:
            yield overlap


def misplaced(state: MujocoState) -> Iterator[Overlap]:
    """Geoms that are so deep in each other that they cannot be meant to be there."""
    radii = state.model.geom_rbound
    for overlap in overlaps(state):
        least = min(radii[g] for g in overlap.geoms if radii[g] > 0)
        if overlap.depth > PIERCES * least:
            yield overlap


def overlaps(state: MujocoState) -> Iterator[Overlap]:
    """All pairs of geoms that MuJoCo's filters let touch, and that are in each other."""
    for touch in candidates(state):
        a, b = sorted(touch.geom.tolist())
        if {geom_kind(state, a), geom_kind(state, b)} <= {*KINDS_OF_GEOMS}:
            depth = depth_of(state, a, b)
            if depth > 0:
                yield Overlap(f"{state.called('geom', a)}/{state.called('geom', b)}", (a, b), depth)


def depth_of(state: MujocoState, a: int, b: int) -> float:
    """How deep two geoms are in each other [m]; below zero where they are apart."""
    R = state.data.xmat.reshape(-1, 3, 3)
    t = state.data.xpos
    sides = (placed(state, a), placed(state, b))
    try:
        pair = ContactPair(f"{a}/{b}", *sides, 0.0, 0.0, rows=4, k=1)
        shapes = in_world(pair, R, t)
        return -pair_and_gaps(pair.name, *shapes)[0].phi
    except ContactError:  # no one normal: their middles coincide
        return depth_along_axes(*shapes)


def depth_along_axes(a: ShapeInWorld, b: ShapeInWorld) -> float:
    """The least depth of two solids along 26 directions [m]: of round ones the depth itself."""
    every: Array = np.array([d for d in product((-1.0, 0.0, 1.0), repeat=3) if any(d)])
    directions = every / np.linalg.norm(every, axis=1, keepdims=True)
    turned = np.concatenate([directions @ a.R.T, directions @ b.R.T])
    return -float(gaps(a, b, turned).max())
