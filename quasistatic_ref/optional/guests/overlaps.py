"""Bodies that overlap in MuJoCo, by this package's distances."""

from collections.abc import Iterator
from typing import NamedTuple

from quasistatic_ref.contact.distance import in_world
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.optional.guests.mujoco_state import MujocoState
from quasistatic_ref.optional.guests.places import KINDS_OF_GEOMS, candidates, geom_kind, placed
from quasistatic_ref.tolerances import DEEP, PIERCES


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
    sides = (placed(state, a), placed(state, b))
    pair = ContactPair(f"{a}/{b}", *sides, 0.0, 0.0, rows=4, k=1)
    return -solid_pair(pair.name, *in_world(pair, R, state.data.xpos)).phi
