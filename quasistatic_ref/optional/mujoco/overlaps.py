"""Geoms that are in each other, whatever MuJoCo makes of them."""

from collections.abc import Iterator
from typing import NamedTuple

from quasistatic_ref.contact.distance import in_world
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.optional.mujoco import touches
from quasistatic_ref.optional.mujoco.findings import APART, Named
from quasistatic_ref.optional.mujoco.mujoco_state import MujocoState
from quasistatic_ref.optional.mujoco.places import KINDS_OF_GEOMS, candidates, geom_kind, placed
from quasistatic_ref.optional.mujoco.tolerances import DEEP, PIERCES
from quasistatic_ref.simulate.finding import Finding


class Overlap(NamedTuple):
    """Two geoms in each other.

    Parameters
    ----------
    geoms : tuple of int
        By their numbers.
    depth : float
        [m].
    """

    geoms: tuple[int, int]
    depth: float


def unlisted(state: MujocoState) -> Iterator[Named]:
    """Findings on geoms that are deep in each other, and that MuJoCo lists no contact of."""
    listed = {tuple(sorted(touch.geom.tolist())) for touch in state.data.contact}
    for overlap in overlaps(state):
        if overlap.geoms not in listed and overlap.depth > DEEP:
            yield _penetrates(state, overlap, "now, without a contact of MuJoCo's")


def misplaced(state: MujocoState) -> Iterator[Named]:
    """Findings on geoms that overlap so deeply at the start that it must be a mistake."""
    radii = state.model.geom_rbound
    for overlap in overlaps(state):
        least = min(radii[g] for g in overlap.geoms if radii[g] > 0)
        if overlap.depth > PIERCES * least:
            yield _penetrates(state, overlap, "at the start")


def _penetrates(state: MujocoState, overlap: Overlap, when: str) -> Named:
    """The finding that two geoms overlap."""
    a, b = overlap.geoms
    body, other = touches.mover_name(state, a), touches.mover_name(state, b)
    if body == "world":
        body, other = other, body
    depth = 1e3 * overlap.depth
    geoms = f"{state.called('geom', a)}/{state.called('geom', b)}"
    cause = f"{geoms}: {body} and {other} overlap by {depth:.3g} mm {when}"
    return body, Finding("penetrates", True, APART, cause, {"depth_mm": depth})


def overlaps(state: MujocoState) -> Iterator[Overlap]:
    """All pairs of geoms that MuJoCo's filters let touch, and that are in each other."""
    R = state.data.xmat.reshape(-1, 3, 3)
    for touch in candidates(state):
        a, b = sorted(touch.geom.tolist())
        if {geom_kind(state, a), geom_kind(state, b)} <= {*KINDS_OF_GEOMS}:
            sides = (placed(state, a), placed(state, b))
            pair = ContactPair(f"{a}/{b}", *sides, 0.0, 0.0, rows=4, k=1)
            phi = solid_pair(pair.name, *in_world(pair, R, state.data.xpos)).phi
            if phi < 0:
                yield Overlap((a, b), -phi)
