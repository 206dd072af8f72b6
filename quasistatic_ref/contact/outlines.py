"""The faces of a convex mesh as far as its numbers resolve them: on what another body lies.

Files write the corners of one face with some digits, so that the hull has many facets there, which
differ by nanometres, and edges and corners between. Distances are of the hull as it is; contacts
are chosen of outlines. A face is all facets that hang together and whose corners are within a grain
of one plane, its outline the polygon of these corners, without those within a grain of a side.
"""

from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np

from quasistatic_ref.contact.shape_in_world import ShapeInWorld, Witness
from quasistatic_ref.contact.solids.polytope import Polytope, polytope
from quasistatic_ref.numbers.angles import cos_sin
from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.numbers.ordered import dot, norm
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import Box, HalfSpace, Shape
from quasistatic_ref.tolerances import FACING, SAME_NORMAL, UPRIGHT

GRAIN: Final = 2e-5
"""How far off their plane corners of one face are at most, relative to the mesh's extent [-]: four
times what the coarsest exporter rounds by."""
LOOSE: Final = 4.0
"""Grains from a facet's plane within which others may be of its face [-]: a small one is tilted."""
ENDS: Final = 0.75
"""Least part of the facets around one, by area, that is its face [-]."""
FAILURES: Final = 8
"""Facets of one piece of a curved surface that are tried without a face, before no other is; a face
counts an eighth of it: it takes time, too."""
FACED: Final = cos_sin(FACING)[0]


@dataclass(frozen=True, eq=False)
class Outlines:
    """Faces of a mesh within its grain.

    Parameters
    ----------
    flat : Polytope
        With these faces, and their outlines as edges.
    corners : ndarray of bool, shape (V,)
        Which vertices are corners of an outline.
    normals : ndarray, shape (T, 3)
        Of the face of each triangle [-].
    width : ndarray, shape (F,)
        Least width of each face; 0 of one narrower than two grains [m].
    """

    flat: Polytope
    corners: Mask
    normals: Array
    width: Array


def outlines(mesh: ConvexMesh) -> Outlines:
    """The outlines of a mesh, kept with it."""
    kept = mesh.__dict__
    if "_outlines" not in kept:
        kept["_outlines"] = _outlines(mesh)
    of_mesh: Outlines = kept["_outlines"]
    return of_mesh


def grain(*shapes: Shape) -> float:
    """How far corners of one place may be apart between shapes [m]; only meshes have a grain."""
    return GRAIN * sum(shape.extent for shape in shapes if isinstance(shape, ConvexMesh))


def bearing_corners(shape: Shape) -> Mask:
    """Which corners of a shape are candidates, shape (N,): those of outlines."""
    if isinstance(shape, ConvexMesh):
        return outlines(shape).corners
    return np.ones(shape.corner_count, dtype=bool)


class Lie(NamedTuple):
    """How two faces lie on each other; both are 0 where none do.

    Parameters
    ----------
    grain : float
        Of the pair [m].
    tilt : float
        How far the normal of either may be off the pair's within its grain [-].
    """

    grain: float
    tilt: float


NO_LIE: Final = Lie(0.0, 0.0)


def lie(grain: float, a: ShapeInWorld, b: ShapeInWorld, nearest: Witness) -> Lie:
    """How faces of two solids with these closest points lie on each other within a grain [m]."""
    if not grain:
        return NO_LIE
    n = nearest.n
    tilts = [
        _tilt(solid.shape, solid.pose.local(x), solid.pose.local_direction(way), grain)
        for solid, x, way in ((a, nearest.alpha, n), (b, nearest.beta, -n))
    ]
    return Lie(grain, max(tilts)) if min(tilts) > 0 else NO_LIE


def _tilt(shape: Shape, x: Array, n: Array, grain: float) -> float:
    """How far a normal may be off the face that holds a point [-]; 0 if there is none.

    Parameters
    ----------
    shape : Shape
    x, n : ndarray, shape (3,)
        The point [m] and the normal out of the shape there [-], in its frame.
    grain : float
        Of the pair [m].
    """
    if isinstance(shape, HalfSpace):
        return SAME_NORMAL
    if isinstance(shape, Box):
        width = 2 * np.sort(shape.half_extents)[1]
        return SAME_NORMAL + grain / width if np.abs(n).max() > 1 - UPRIGHT else 0.0
    if not isinstance(shape, ConvexMesh):
        return 0.0
    faces = outlines(shape)
    wide = faces.width > 0
    may = SAME_NORMAL + grain / np.where(wide, faces.width, np.inf)
    on = wide & (np.abs(faces.flat.normals - n).max(axis=1) <= may)
    on &= faces.flat.normals @ x >= faces.flat.offsets - grain
    return float(may[on].max(initial=0.0))


class _Facets:
    """The triangles of a mesh, the pairs of neighbours, and which of these are of one face."""

    def __init__(self, mesh: ConvexMesh) -> None:
        self.grain = GRAIN * mesh.extent
        self.points = mesh.vertices
        self.triangles = mesh.triangles
        self.normals = mesh.normals
        self.offsets = mesh.offsets
        a, b, c = self.points[self.triangles].transpose(1, 0, 2)
        self.area = norm(np.cross(b - a, c - a)) / 2
        self.longest = np.max([norm(b - a), norm(c - b), norm(a - c)], axis=0)
        # Others are needles, whose normals are rounding.
        self.wide = self.area > self.grain * self.longest
        count = len(self.triangles)
        ends = np.concatenate([self.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
        edge = ends.min(axis=1) * len(self.points) + ends.max(axis=1)
        order = np.argsort(edge, kind="stable")
        self.pairs = (order % count).reshape(-1, 2)
        self.ends = ends[order[::2]]
        one, other = self.pairs.T
        self.equal = (self.normals[one] == self.normals[other]).all(axis=1)
        self.equal &= self.offsets[one] == self.offsets[other]
        near = self._depth(one, other)
        back = self._depth(other, one)
        self.linked = self.equal | (np.minimum(near, back) <= LOOSE * self.grain)
        self.depth = np.zeros(count)
        np.maximum.at(self.depth, one, np.where(self.linked, near, 0.0))
        np.maximum.at(self.depth, other, np.where(self.linked, back, 0.0))

    def _depth(self, one: Indices, other: Indices) -> Array:
        """How far corners of others are below planes of some; infinite where they face away."""
        n = self.normals[one]
        x = self.points[self.triangles[other]]
        depth = (self.offsets[one, None] - dot(x, n[:, None])).max(axis=1)
        facing = dot(n, self.normals[other]) >= FACED
        return np.where(self.wide[one] & (facing | ~self.wide[other]), depth, np.inf)

    def pieces(self, linked: Mask) -> Indices:
        """The number of the piece of each triangle, shape (T,); pairs that are linked have one."""
        from scipy.sparse import coo_array  # as the hull takes scipy
        from scipy.sparse.csgraph import connected_components

        one, other = self.pairs[linked].T
        shape = (len(self.triangles),) * 2
        _, piece = connected_components(coo_array((np.ones(len(one)), (one, other)), shape), False)
        return np.asarray(piece, dtype=np.int64)

    def corners_of(self, some: Indices, face: Indices) -> tuple[Indices, Indices]:
        """Faces of some facets and their corners, both shape (N,), each once and face by face."""
        every = np.unique(face.repeat(3) * len(self.points) + self.triangles[some].ravel())
        return np.divmod(every, len(self.points))

    def planes(self, some: Indices, face: Indices) -> tuple[Array, Array, Array]:
        """Planes fitted to corners of faces 0 to F - 1 of some facets, and how far they are off.

        Normals (F, 3) [-], offsets and depths (F,) [m].
        """
        owner, corner = self.corners_of(some, face)
        x = self.points[corner]
        start = np.flatnonzero(np.diff(owner, prepend=-1))
        middle = np.add.reduceat(x, start) / np.bincount(owner)[:, None]
        away = x - middle[owner]
        n = np.linalg.eigh(np.add.reduceat(away[:, :, None] * away[:, None], start))[1][:, :, 0]
        order = np.lexsort((-self.area[some], face))
        largest = some[order[np.flatnonzero(np.diff(face[order], prepend=-1))]]
        n = n * np.sign(dot(n, self.normals[largest]))[:, None]
        return n, dot(n, middle), np.maximum.reduceat(np.abs(dot(away, n[owner])), start)

    def grown(self, t: int, some: Indices) -> Indices:
        """The facets of the face of a facet t among some of its piece; none if it has none.

        Around a convex body those near to a plane hang together.
        """
        n = self.normals[t]
        offset = float(self.offsets[t])
        around = 0.0
        for gives in (LOOSE, LOOSE / 2, 1.0):
            off = np.abs(self.points @ n - offset) <= gives * self.grain
            near = off[self.triangles[some]].all(axis=1)
            face: Indices = some[near & (self.normals[some] @ n >= FACED)]
            if t not in face:
                return face[:0]
            around = around or float(self.area[face].sum())
            x = self.points[np.unique(self.triangles[face])]
            middle = x.mean(axis=0)
            way = np.linalg.eigh((x - middle).T @ (x - middle))[1][:, 0]
            n = way * np.sign(way @ n)
            offset = float(n @ middle)
        # A face ends; a curved surface goes on, twice as far within four times the depth.
        return face[: len(face) * (self.area[face].sum() >= ENDS * around)]


def _outlines(mesh: ConvexMesh) -> Outlines:
    exact = polytope(mesh)
    assert exact is not None
    facets = _Facets(mesh)
    face, merged = _faces(facets)
    first = np.unique(face, return_index=True)[1]
    of_face = mesh.normals[first]
    offsets = mesh.offsets[first]
    some = np.flatnonzero(merged)
    if len(some):
        fitted, number = np.unique(face[some], return_inverse=True)
        of_face[fitted], offsets[fitted], _ = facets.planes(some, number.reshape(-1))
    tail, tip, owner, width = _rings(facets, face, of_face)
    corners = np.zeros(len(mesh.vertices), dtype=bool)
    corners[tail] = True
    if not len(some) and corners.all():
        order = np.lexsort(np.column_stack([of_face, offsets]).T[::-1])  # as of exact faces
        return Outlines(exact, corners, mesh.normals, width[order])
    key = np.minimum(tail, tip) * len(mesh.vertices) + np.maximum(tail, tip)
    edges, start = np.unique(key, return_index=True)
    last = len(key) - 1 - np.unique(key[::-1], return_index=True)[1]
    sides = owner[np.column_stack([start, last])]
    ends = np.column_stack(np.divmod(edges, len(mesh.vertices)))
    flat = replace(exact, normals=of_face, offsets=offsets, edges=ends, sides=sides)
    normals = np.where(merged[:, None], of_face[face], mesh.normals)
    return Outlines(flat, corners, normals, width)


def _faces(facets: _Facets) -> tuple[Indices, Mask]:
    """The number of the face of each facet, and whether it is of a face of several planes."""
    piece = facets.pieces(facets.linked)
    merged = np.zeros(len(piece), dtype=bool)
    of_several = np.zeros(len(piece), dtype=bool)
    of_several[piece[facets.pairs[facets.linked & ~facets.equal, 0]]] = True
    some = np.flatnonzero(of_several[piece])
    if not len(some):
        return piece, merged
    number = np.unique(piece[some], return_inverse=True)[1].reshape(-1)
    normals, _, off = facets.planes(some, number)
    facing = dot(facets.normals[some], normals[number]) >= FACED
    curved = off > facets.grain
    curved[number[~facing & facets.wide[some]]] = True
    merged[some] = facing & ~curved[number]
    left = some[curved[number]]
    alike = facets.pieces(facets.equal)
    face = np.where(np.isin(np.arange(len(piece)), left), len(piece) + alike, piece)
    # Of a piece that is no face, the flattest and largest facets are tried first.
    left = left[np.lexsort((-facets.area[left], facets.depth[left] > facets.grain, piece[left]))]
    for rest in np.split(left, np.flatnonzero(np.diff(piece[left])) + 1):
        failures = 0.0
        for t in (
            rest[facets.wide[rest]].tolist() if len(rest) > 2 else []
        ):  # two: one face, or none
            if failures > FAILURES:
                break
            if merged[t]:
                continue
            grown = facets.grown(t, rest[~merged[rest]])
            if len(grown) and np.ptp(alike[grown]):
                face[grown] = 2 * len(piece) + t
                merged[grown] = True
                failures += 1 / 8
            else:
                failures += 1
    return np.unique(face, return_inverse=True)[1].reshape(-1), merged


def _rings(
    facets: _Facets, face: Indices, normals: Array
) -> tuple[Indices, Indices, Indices, Array]:
    """Tails, tips and faces of the sides of all outlines, shape (S,), and widths of faces."""
    count = np.bincount(face)
    width = np.zeros(len(normals))
    alone = np.flatnonzero((count[face] == 1) & facets.wide)
    width[face[alone]] = 2 * facets.area[alone] / facets.longest[alone]
    tails = [facets.triangles[alone].ravel()]
    tips = [np.roll(facets.triangles[alone], -1, axis=1).ravel()]
    owners = [face[alone].repeat(3)]
    some = np.flatnonzero(count[face] > 1)
    owner, corner = facets.corners_of(some, face[some])
    start = np.flatnonzero(np.diff(owner, prepend=-1))
    stop = np.append(start[1:], len(owner))
    four = start[stop - start == 4]
    ring = corner[four[:, None] + np.arange(4)]
    ring, wide, plain = _quads(facets.points[ring], ring, normals[owner[four]], facets.grain)
    width[owner[four[plain]]] = wide[plain]
    ring = ring[plain & (wide > 0)]
    tails.append(ring.ravel())
    tips.append(np.roll(ring, -1, axis=1).ravel())
    owners.append(owner[four[plain & (wide > 0)]].repeat(4))
    others = ~np.isin(start, four[plain])
    for i, j in zip(start[others].tolist(), stop[others].tolist(), strict=True):
        ring, width[owner[i]] = _outline(
            facets.points[corner[i:j]], normals[owner[i]], facets.grain
        )
        if width[owner[i]]:
            around = corner[i:j][ring]
            tails.append(around)
            tips.append(np.roll(around, -1))
            owners.append(np.full(len(ring), owner[i]))
    return np.concatenate(tails), np.concatenate(tips), np.concatenate(owners), width


def _quads(x: Array, corner: Indices, n: Array, grain: float) -> tuple[Indices, Array, Mask]:
    """Faces of four corners: these around each (Q, 4), widths (Q,), and which are convex so.

    Parameters
    ----------
    x, corner : ndarray, shapes (Q, 4, 3) and (Q, 4)
        Four corners in any order [m], and their numbers.
    n : ndarray, shape (Q, 3)
        [-].
    grain : float
        [m].
    """
    away = x - x.mean(axis=1, keepdims=True)
    first = away[:, :1]
    angle = np.arctan2(dot(np.cross(first, away), n[:, None]), dot(first, away))
    order = angle.argsort(axis=1)
    x = np.take_along_axis(x, order[..., None], axis=1)
    side = np.roll(x, -1, axis=1) - x
    inward = np.cross(n[:, None], side) / norm(side)[..., None]
    height = inward @ x.mT - dot(inward, x)[..., None]
    width = height.max(axis=2).min(axis=1)
    chord = np.roll(x, -1, axis=1) - np.roll(x, 1, axis=1)
    off = dot(np.cross(np.roll(side, 1, axis=1), chord), n[:, None]) / norm(chord)
    plain = ((off > grain) & (height.min(axis=2) >= -grain)).all(axis=1)
    return np.take_along_axis(corner, order, axis=1), np.where(width > 2 * grain, width, 0.0), plain


def _outline(points: Array, n: Array, grain: float) -> tuple[Indices, float]:
    """Numbers of the points around a face, counter-clockwise, and its least width [m]."""
    from scipy.spatial import ConvexHull  # as the hull takes scipy

    axis = int(np.abs(n).argmin())
    along = np.cross(n, np.eye(3)[axis])
    along = along / norm(along)
    x = points @ np.column_stack([along, np.cross(n, along)])
    ring = ConvexHull(x, qhull_options="QJ").vertices  # QJ: all in a line, as well
    while len(ring) > 3:
        p = x[ring]
        chord = np.roll(p, -1, axis=0) - np.roll(p, 1, axis=0)
        way = p - np.roll(p, 1, axis=0)
        off = np.abs(chord[:, 0] * way[:, 1] - chord[:, 1] * way[:, 0]) / np.hypot(*chord.T)
        least = int(off.argmin())
        if off[least] > grain:
            break
        ring = np.delete(ring, least)
    p = x[ring]
    side = np.roll(p, -1, axis=0) - p
    inward = np.column_stack([-side[:, 1], side[:, 0]]) / np.hypot(*side.T)[:, None]
    height = inward @ p.T - (inward * p).sum(axis=1)[:, None]
    width = float(height.max(axis=1).min())
    return ring, width if width > 2 * grain else 0.0
