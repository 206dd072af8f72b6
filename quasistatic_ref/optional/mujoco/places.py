"""What may touch in a MuJoCo model: pairs of geoms, and places for their contacts in every step."""

from __future__ import annotations

import copy
from collections import Counter
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.normals import UNIQUE_NORMAL
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ModelError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.mujoco.mujoco_state import MujocoState
from quasistatic_ref.optional.mujoco.touches import USED_OR_IN_GAP, friction
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    PlacedShape,
    Shape,
    Sphere,
)
from quasistatic_ref.tolerances import FILLED, REPEATED

if TYPE_CHECKING:
    from mujoco import MjContact, MjModel

ALL = 1e6
"""Gap at which MuJoCo's filters alone decide what may touch [m]."""
SHAPES: dict[str, Callable[[Array], Shape]] = {
    "PLANE": lambda size: HalfSpace(np.array([0.0, 0.0, 1.0]), 0.0),
    "SPHERE": lambda size: Sphere(size[0]),
    "CAPSULE": lambda size: Capsule(size[0], size[1]),
    "CYLINDER": lambda size: Cylinder(size[0], size[1]),
    "BOX": Box,
    "ELLIPSOID": Ellipsoid,
}
"""Shapes of geoms by their kinds, from ``geom_size``."""
MESH = "MESH"
KINDS_OF_GEOMS = (*SHAPES, MESH)
"""Kinds of geoms that have a shape of this package."""
ONE, TWO = ("SPHERE", "ELLIPSOID"), ("CAPSULE",)
PLACES_OF_BOXES = 8
"""Places of two boxes: as many corners as a face has that is cut by a face."""
PLACES = 4
"""Places of any other pair: no more contacts matter. What is round has one, a capsule two."""

MOST_PLACES = 20_000
"""Most places for contacts: they take some 20 kB each."""
MOST_ENTRIES = 10_000_000
"""Most entries of J."""


class Places:
    """Pairs of geoms that MuJoCo's filters let touch, and the places of their contacts.

    Parameters
    ----------
    state : MujocoState
        Its gaps become those of a run.
    margin : float
        Gap up to which MuJoCo looks for contacts [m].

    Attributes
    ----------
    pairs : tuple of ContactPair
    shapes : dict of int to PlacedShape
        Of the geoms of the pairs, by number; the world has those of bodies that never move.
    first : ndarray of int, shape (pairs,)
        Place of the nearest contact of each pair.
    margins : dict of str to float
        Distances at which MuJoCo lets pairs push, by their names, where not zero [m].

    Raises
    ------
    ModelError
        If friction differs in two directions, a geom is a field, or the places are too many.
    """

    def __init__(self, state: MujocoState, margin: float) -> None:
        if not 0 < margin < FILLED:
            raise ModelError("must be greater than 0", field="margin", value=margin)
        self.margin = margin
        self.shapes: dict[int, PlacedShape] = {}
        self.geoms = np.zeros((0, 2), dtype=np.int64)
        pairs = []
        geoms = []
        touching = candidates(state, ALL)
        _check_count(state, touching)
        for touch in touching:
            a, b = sorted(touch.geom.tolist(), key=lambda g: (state.model.geom_type[g], g))
            pairs.append(self._pair(state, touch, a, b))
            geoms.append((a, b))
        self.pairs = tuple(pairs)
        gaps = [float(touch.includemargin) for touch in touching]
        self.margins = {pair.name: gap for pair, gap in zip(pairs, gaps, strict=True) if gap}
        self.geoms = np.array(geoms, dtype=np.int64).reshape(-1, 2)
        self.counts = np.array([pair.n_c for pair in pairs], dtype=np.int64)
        self.first = np.cumsum(self.counts) - self.counts
        self.number = {frozenset(two): i for i, two in enumerate(geoms)}
        for field, share in _gaps(state.adapted):
            field += share * margin

    def _pair(self, state: MujocoState, touch: MjContact, a: int, b: int) -> ContactPair:
        for g in (a, b):
            if g not in self.shapes:
                self.shapes[g] = placed(state, g)
        sides = [self.shapes[g] for g in (a, b)]
        name = f"{_tree(state, a)}-{_tree(state, b)}({sides[0].name}, {sides[1].name})"
        mu_v, mu_omega, rows = friction(touch, name)
        k = _places_of(state, a, b)
        return ContactPair(name, sides[0], sides[1], mu_v, mu_omega, rows=rows, k=k)

    def points(self, state: MujocoState) -> ClosestPoints:
        """The contacts of all pairs in their places, in each pair by ascending distance.

        phi is MuJoCo's distance less its margin; alpha and beta are on the surfaces. Places beyond
        those of a pair's contacts have the centres of its geoms, a vertical normal, and the gap
        ``FILLED``, at which no row binds.
        """
        listed = state.data.contact
        dist = np.asarray(listed.dist)
        phi = dist - listed.includemargin
        used = np.isin(listed.exclude, USED_OR_IN_GAP)
        geoms = np.asarray(listed.geom).reshape(-1, 2).tolist()
        normals = listed.frame.reshape(-1, 9)[:, :3]
        middles = listed.pos.reshape(-1, 3)
        of_place = np.repeat(np.arange(len(self.pairs)), self.counts)
        centres = state.data.geom_xpos[self.geoms[of_place]]
        every = ClosestPoints(
            phi=np.full(len(of_place), FILLED),
            alpha=centres[:, 0],
            beta=centres[:, 1],
            n=np.tile([0.0, 0.0, 1.0], (len(of_place), 1)),
            point=np.arange(len(of_place)) - self.first[of_place],
            tie=np.full(len(of_place), UNIQUE_NORMAL),
        )
        count = np.zeros(len(self.pairs), dtype=np.int64)
        for i in np.argsort(phi, kind="stable").tolist():
            pair = self.number.get(frozenset(geoms[i]))
            if not used[i] or pair is None or count[pair] == self.counts[pair]:
                continue
            place = self.first[pair] + count[pair]
            count[pair] += 1
            n = normals[i] if geoms[i][0] == self.geoms[pair, 0] else -normals[i]
            half = dist[i] / 2 * n
            every.phi[place] = phi[i]
            every.alpha[place] = middles[i] - half
            every.beta[place] = middles[i] + half
            every.n[place] = n
        return every._replace(phi=every.phi + 0.0, n=every.n + 0.0)


def overlapped_children(state: MujocoState, places: Places) -> tuple[str, ...]:
    """Sentences on bodies that overlap those they are jointed to, where MuJoCo sees contact.

    Its filter of parents and children leaves out bodies that are part of the world.
    """
    model = state.model
    phi = places.points(state).phi[places.first]
    weld, root = model.body_weldid, model.body_rootid
    depths: dict[int, dict[str, float]] = {}
    for i in np.flatnonzero(phi < -REPEATED).tolist():
        still, moving = sorted(model.geom_bodyid[places.geoms[i]].tolist(), key=lambda b: weld[b])
        holder = model.body_parentid[weld[moving]]
        if still and not weld[still] and not weld[holder] and root[still] == root[moving]:
            depth = depths.setdefault(still, {})
            child = state.words("body", moving)
            depth[child] = max(depth.get(child, 0.0), -1e3 * float(phi[i]))
    return tuple(
        f"{state.words('body', parent)} has no joint, so that MuJoCo lets it touch what joints "
        f"hold to it, and overlaps {', '.join(sorted(depth))} by up to {max(depth.values()):.3g} "
        "mm at the start: give it a <freejoint/>, or exclude these pairs (contact/exclude)"
        for parent, depth in depths.items()
    )


def _places_of(state: MujocoState, a: int, b: int) -> int:
    """Number of contact places of a pair of geoms, by their kinds."""
    kinds = {geom_kind(state, g) for g in (a, b)}
    if kinds & {*ONE}:
        return 1
    if kinds & {*TWO}:
        return 2
    return PLACES_OF_BOXES if kinds == {"BOX"} else PLACES


def _check_count(state: MujocoState, touching: list[MjContact]) -> None:
    """Refuse pairs of more places than a step has memory for, naming the trees that have most."""
    counts: Counter[tuple[str, ...]] = Counter()
    for touch in touching:
        trees = tuple(sorted(_tree(state, g) for g in touch.geom.tolist()))
        counts[trees] += _places_of(state, *touch.geom.tolist())
    places = counts.total()
    if places <= MOST_PLACES and 4 * places * state.model.nv <= MOST_ENTRIES:
        return
    (trees, most) = counts.most_common(1)[0]
    problem = (
        f"are {len(touching)} pairs with {places} places for contacts, by {state.model.nv} "
        f"coordinates, and a run has at most {MOST_PLACES} and {MOST_ENTRIES} entries of J; "
        f"{most} of them are of {trees[0]} and {trees[1]}: exclude them (contact/exclude, "
        "contype, conaffinity), or take fewer geoms"
    )
    raise ModelError(problem, field="geoms that may touch")


def candidates(state: MujocoState, gap: float = 0.0) -> list[MjContact]:
    """One contact of each pair of geoms that may touch within a gap [m], by MuJoCo's filters.

    All geoms but planes are their bounding balls there.

    Raises
    ------
    ModelError
        If they are more than MuJoCo's memory or a run holds.
    """
    mujoco = state.mujoco
    balls = copy.copy(state.adapted)
    plane, ball = int(mujoco.mjtGeom.mjGEOM_PLANE), int(mujoco.mjtGeom.mjGEOM_SPHERE)
    is_plane = balls.geom_type == plane
    balls.geom_type[:] = np.where(is_plane, plane, ball)
    balls.geom_size[~is_plane, 0] = balls.geom_rbound[~is_plane]
    for gaps, _ in _gaps(balls):
        gaps += gap
    data = copy.copy(state.data)
    mujoco.mj_kinematics(balls, data)
    try:
        mujoco.mj_collision(balls, data)
        full = data.warning[mujoco.mjtWarning.mjWARN_CONTACTFULL].number > 0
    except mujoco.FatalError:
        full = True
    if full or data.ncon > MOST_PLACES:
        count = int(((balls.geom_contype | balls.geom_conaffinity) != 0).sum())
        problem = (
            f"are {count}, and make more pairs than size.memory holds, {balls.narena} bytes, or a "
            f"run, {MOST_PLACES}; raise size.memory, or exclude some (contact/exclude, contype, "
            "conaffinity)"
        )
        raise ModelError(problem, field="geoms that may touch")
    each = {tuple(sorted(touch.geom.tolist())): touch for touch in data.contact}
    return [each[geoms] for geoms in sorted(each)]


def _gaps(model: MjModel) -> tuple[tuple[Array, float], ...]:
    """The numbers by which MuJoCo decides at what gap two geoms have a contact."""
    return (model.geom_gap, 0.5), (model.pair_gap, 1.0), (model.body_margin, 0.5)


def _tree(state: MujocoState, g: int) -> str:
    """The tree of a geom, or the world."""
    model = state.model
    body = model.geom_bodyid[g]
    return state.called("body", model.body_rootid[body]) if model.body_weldid[body] else "world"


def placed(state: MujocoState, g: int) -> PlacedShape:
    """A geom in the frame of its body, or in the world if that never moves."""
    model, data = state.model, state.data
    body = int(model.geom_bodyid[g])
    name = state.name("geom", g) or f"geom{g}"
    if not model.body_weldid[body]:
        state.mujoco.mj_kinematics(model, data)
        R, t = data.geom_xmat[g].reshape(3, 3).copy(), data.geom_xpos[g].copy()
        return PlacedShape(name, 0, R, t, _shape(state, g))
    turn = np.zeros(9)
    state.mujoco.mju_quat2Mat(turn, model.geom_quat[g])
    return PlacedShape(name, body, turn.reshape(3, 3), model.geom_pos[g].copy(), _shape(state, g))


def geom_kind(state: MujocoState, g: int) -> str:
    """The kind of a geom, such as ``"BOX"``."""
    kind = state.mujoco.mjtGeom(int(state.model.geom_type[g]))
    return str(kind.name).removeprefix("mjGEOM_")


def _shape(state: MujocoState, g: int) -> Shape:
    model = state.model
    kind = geom_kind(state, g)
    if kind in SHAPES:
        return SHAPES[kind](model.geom_size[g])
    if kind != MESH:
        problem = "has no places in a run; use meshes or other shapes"
        raise ModelError(problem, field=f"{state.words('geom', g)}.type", value=kind.lower())
    mesh = model.geom_dataid[g]
    first = int(model.mesh_vertadr[mesh])
    vertices = model.mesh_vert[first : first + int(model.mesh_vertnum[mesh])]
    return convex_hull(vertices.astype(np.float64))
