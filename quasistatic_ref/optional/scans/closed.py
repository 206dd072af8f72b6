"""The inside of a closed mesh: corners joined, triangles wound alike, shells told apart."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from quasistatic_ref.errors import InputError
from quasistatic_ref.optional.scans.solid import Solid
from quasistatic_ref.step.arrays import Array, Indices

JOINED = 1e-7
"""Corners so near to each other, over the extent, are one [-]: a bit of a float32 is 6e-8."""
SHIFTED = 1e-5
"""How far a point is moved off its triangle, over the extent, to see what is on either side [-]."""
SAMPLES = 1200
"""Points of a shell, on its largest triangles, by which it is seen where it is."""


def solid_of_mesh(vertices: Array, triangles: Indices, notes: list[str]) -> Solid | None:
    """The inside of a mesh of V vertices, (V, 3) [m], and triangles, (T, 3); None if it is open.

    Corners at one place are joined, and triangles without area left out. A triangle that stands
    twice counts once, one that is wound against its neighbours is turned, and so is a mesh that is
    wound inwards. What was done is added to `notes`.

    Raises
    ------
    InputError
        If shells of the mesh overlap, or one lies inside another and the file does not say whether
        it is a cavity.
    """
    extent = float(np.ptp(vertices, axis=0).max())
    corners = _joined(vertices, JOINED * extent)[triangles]
    area = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
    corners = corners[area]
    for single in (_once(corners, wound=True), _once(corners, wound=False)):
        alike = _wound_alike(single)
        if alike is not None:
            break
    else:
        return None
    faces, turned, shells = alike
    if len(single) < len(corners):
        notes.append(f"{len(corners) - len(single)} triangles that stand twice count once")
    if turned:
        notes.append(f"{turned} triangles are wound against their neighbours: turned")
    if _outward(vertices, faces, shells, extent) < 0:
        faces = faces[:, ::-1]
        notes.append("the mesh is wound inwards: turned")
    return Solid.of_mesh(vertices, faces)


def _joined(vertices: Array, apart: float) -> Indices:
    """For each vertex the number of the first that stands at its place, shape (V,)."""
    _, first, same = np.unique(vertices, axis=0, return_index=True, return_inverse=True)
    pairs = cKDTree(vertices[first]).query_pairs(apart, output_type="ndarray")
    near = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(first), len(first)))
    _, group = connected_components(near, directed=False)
    _, chosen = np.unique(group, return_index=True)
    return np.asarray(first[chosen[group]][same.ravel()])


def _once(faces: Indices, *, wound: bool) -> Indices:
    """The triangles, each once; two that are wound differently are two only if that is asked."""
    ends = np.sort(faces, axis=1)
    if wound:
        first = faces.argmin(axis=1)[:, None]
        ends = np.take_along_axis(faces, (first + np.arange(3)) % 3, axis=1)
    return faces[np.sort(np.unique(ends, axis=0, return_index=True)[1])]


def _wound_alike(faces: Indices) -> tuple[Indices, int, list[Indices]] | None:
    """The triangles of a closed mesh, wound alike; None if it is open.

    With how many were turned, and the numbers of the triangles of each closed shell.
    """
    if not len(faces):
        return None
    T = len(faces)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    of = np.tile(np.arange(T), 3)
    up = edges[:, 0] < edges[:, 1]
    _, edge, uses = np.unique(
        np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    edge = edge.ravel()
    if (uses % 2).any():
        return None
    order = np.argsort(edge, kind="stable")
    pairs = order[uses[edge[order]] == 2].reshape(-1, 2)
    a, b = of[pairs].T
    differ = up[pairs[:, 0]] == up[pairs[:, 1]]
    # Node f is triangle f as it is, node T + f that triangle turned.
    start = np.concatenate([a, a + T])
    end = np.concatenate([np.where(differ, b + T, b), np.where(differ, b, b + T)])
    links = coo_matrix((np.ones(len(start)), (start, end)), shape=(2 * T, 2 * T))
    _, group = connected_components(links, directed=False)
    if (group[:T] == group[T:]).any():
        return None  # it has one side only
    # Of the two ways to wind a shell, the one that most of its triangles have.
    shell = np.unique(np.minimum(group[:T], group[T:]), return_inverse=True)[1]
    first = group[:T] < group[T:]
    majority = 2 * np.bincount(shell, first) >= np.bincount(shell)
    turn = first != majority[shell]
    alike = np.where(turn[:, None], faces[:, ::-1], faces)
    way = np.where(up != turn[of], 1, -1)
    if np.bincount(edge, way).any():
        return None
    return alike, int(turn.sum()), _shells(alike, edge, way, np.tile(shell, 3))


def _shells(faces: Indices, edge: Indices, way: Indices, shell: Indices) -> list[Indices]:
    """Numbers of the triangles of each closed shell: those that edges of two triangles join.

    Where one of these is not closed by itself, those that corners join.

    Parameters
    ----------
    faces : ndarray of int, shape (T, 3)
    edge, way, shell : ndarray of int, shape (3 T,)
        Of each triangle's three edges: number, direction (1 or -1), and number of the shell.
    """
    ends = coo_matrix((way, (edge, shell))).tocsr()
    ends.sum_duplicates()
    of = shell[: len(faces)]
    if ends.data.any():
        n = int(faces.max()) + 1
        start, end = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]]]).T
        links = coo_matrix((np.ones(len(start)), (start, end)), shape=(n, n))
        of = connected_components(links, directed=False)[1][faces[:, 0]]
    return [np.flatnonzero(of == number) for number in np.unique(of)]


def _outward(vertices: Array, faces: Indices, shells: list[Indices], extent: float) -> int:
    """1 of a mesh that is wound outwards, -1 of one that is wound inwards.

    A shell that is within an even number of others bounds the solid from outside, one within an odd
    number from inside, as a cavity does.

    Raises
    ------
    InputError
        If they overlap, or are wound otherwise.
    """
    signs = []
    for shell in shells:
        inside = [
            _inside(vertices, faces[shell], faces[other], extent)
            for other in shells
            if other is not shell
        ]
        partly = [share for share in inside if 0 < share < 1]
        if partly:
            problem = (
                f"{len(shells)} closed shells of the mesh overlap, and their volumes would count "
                "twice; unite them, or give each as a mesh of its own"
            )
            raise InputError(problem, field="mesh")
        volume = Solid.volume_of_mesh(vertices, faces[shell])
        signs.append(np.sign(volume) * (-1) ** round(sum(inside)))
    if len({*signs}) > 1:
        problem = (
            "a closed shell of the mesh lies within another that is wound the same way: a cavity, "
            "or a second part? Wind a cavity inwards, or take the shell away"
        )
        raise InputError(problem, field="mesh")
    return int(signs[0])


def _inside(vertices: Array, faces: Indices, others: Indices, extent: float) -> float:
    """Share of a shell's triangles whose both sides are within another shell, from 0 to 1."""
    corners = vertices[faces]
    walls = vertices[others]
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    apart = SHIFTED * extent
    if (low > walls.max(axis=(0, 1)) - apart).any() or (
        high < walls.min(axis=(0, 1)) + apart
    ).any():
        return 0.0
    a, b, c = np.moveaxis(corners, 1, 0)
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    large = np.argsort(-areas, kind="stable")[:SAMPLES]
    large = large[areas[large] > 0]
    off = apart * normals[large] / areas[large, None]
    m = int(np.ceil(np.sqrt(2 * SAMPLES / len(large))))
    u, v = (np.stack(np.triu_indices(m)) + 1 / 3) / m  # a lattice over a triangle
    parts = np.stack([u, 1 - v, v - u], axis=1)
    points = np.einsum("pk,tki->pti", parts, corners[large])
    within = _within((points + off).reshape(-1, 3), walls)
    within &= _within((points - off).reshape(-1, 3), walls)
    return float(within.mean())


def _within(points: Array, walls: Array) -> NDArray[np.bool_]:
    """Which points, (N, 3), a closed surface of triangles, (T, 3, 3), winds around, shape (N,).

    By the sum of solid angles, tan(angle/2) = det(a, b, c) / (|a||b||c| + ...), over 4 pi.
    """
    turns = np.zeros(len(points))
    for part in np.array_split(walls, 1 + len(walls) * len(points) // 500_000):
        a, b, c = np.moveaxis(part[None] - points[:, None, None], 2, 0)
        A, B, C = (np.linalg.norm(side, axis=-1) for side in (a, b, c))
        above = np.vecdot(a, np.cross(b, c))
        below = A * B * C + np.vecdot(a, b) * C + np.vecdot(b, c) * A + np.vecdot(c, a) * B
        turns += np.arctan2(above, below).sum(axis=1) / (2 * np.pi)
    return np.asarray(abs(turns) > 0.5)
