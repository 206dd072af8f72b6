"""Closed meshes: corners joined, triangles wound alike, shells united."""

import numpy as np
import trimesh
from manifold3d import Error, Manifold, Mesh64
from scipy.spatial import cKDTree

from quasistatic_ref.errors import InputError
from quasistatic_ref.step.arrays import Array, Indices

JOINED = 1e-7
"""Corners so near to each other, over the extent, are one [-]: a bit of a float32 is 6e-8."""
TOUCHING = 1e-6
"""Common part of two shells, over the smaller one, up to which they only touch [-]."""


def closed_mesh(
    vertices: Array, triangles: Indices, notes: list[str]
) -> tuple[Array, Indices] | None:
    """The surface of what a mesh of vertices, (V, 3) [m], and triangles, (T, 3), encloses.

    Its vertices, and its triangles wound outwards; None if the mesh is open.

    Corners at one place are joined, and triangles without area left out. A triangle that stands
    twice counts once, one that is wound against its neighbours is turned, and so is a mesh that is
    wound inwards. Shells that overlap count as what they fill together. What was done is added to
    `notes`.

    Raises
    ------
    InputError
        If a shell lies inside another and the file does not say whether it is a cavity, or reaches
        through another that is wound the other way.
    """
    corners = _joined(vertices, JOINED * float(np.ptp(vertices, axis=0).max()))[triangles]
    corners = corners[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]
    for wound in (True, False):
        single = _once(corners, wound)
        for faces in (single, _wound_alike(vertices, single)):
            mesh = _manifold(vertices, faces)
            if mesh.status() == Error.NoError and not mesh.is_empty():
                if len(single) < len(corners):
                    twice = len(corners) - len(single)
                    notes.append(f"{twice} triangles that stand twice count once")
                if turned := int((faces != single).any(axis=1).sum()):
                    notes.append(f"{turned} triangles are wound against their neighbours: turned")
                whole = _united(mesh, notes).to_mesh64()
                return whole.vert_properties, whole.tri_verts.astype(np.int64)
    return None


def _joined(vertices: Array, apart: float) -> Indices:
    """For each vertex the number of the first that stands at its place, shape (V,)."""
    _, first, same = np.unique(vertices, axis=0, return_index=True, return_inverse=True)
    pairs = cKDTree(vertices[first]).query_pairs(apart, output_type="ndarray")
    group = trimesh.graph.connected_component_labels(pairs, len(first))
    _, chosen = np.unique(group, return_index=True)
    return np.asarray(first[chosen[group]][same.ravel()])


def _once(faces: Indices, wound: bool) -> Indices:
    """The triangles, each once; two that are `wound` differently are two only if that is asked."""
    ends = np.sort(faces, axis=1)
    if wound:
        first = faces.argmin(axis=1)[:, None]
        ends = np.take_along_axis(faces, (first + np.arange(3)) % 3, axis=1)
    return faces[np.sort(np.unique(ends, axis=0, return_index=True)[1])]


def _wound_alike(vertices: Array, faces: Indices) -> Indices:
    """The triangles of each shell as trimesh winds them, or the other way, as most of them were."""
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    trimesh.repair.fix_winding(mesh)
    turned = (mesh.faces != faces).any(axis=1)
    shell = trimesh.graph.connected_component_labels(mesh.face_adjacency, len(faces))
    most = 2 * np.bincount(shell, turned) > np.bincount(shell)
    return np.where((turned != most[shell])[:, None], faces[:, ::-1], faces)


def _united(mesh: Manifold, notes: list[str]) -> Manifold:
    """What the shells of a mesh fill together, from the largest one on, without its cavities."""
    whole, *others = sorted(mesh.decompose(), key=lambda shell: -abs(shell.volume()))
    inwards = whole.volume() < 0
    if inwards:
        notes.append("the mesh is wound inwards: turned")
        whole = _turned(whole)
    overlap = 0
    for shell in others:
        cavity = (shell.volume() < 0) != inwards
        shell = _turned(shell) if shell.volume() < 0 else shell
        common = (whole ^ shell).volume() / shell.volume()
        if common > 1 - TOUCHING and not cavity:
            problem = (
                "a closed shell of the mesh lies within another that is wound the same way: a "
                "cavity, or a second part? Wind a cavity inwards, or take the shell away"
            )
            raise InputError(problem, field="mesh")
        if TOUCHING < common < 1 - TOUCHING and cavity:
            problem = "closed shells of the mesh overlap that are wound different ways; turn one"
            raise InputError(problem, field="mesh")
        overlap += common > TOUCHING and not cavity
        whole = whole - shell if common > TOUCHING and cavity else whole + shell
    if overlap:
        notes.append(f"{overlap + 1} closed shells of the mesh overlap: what they fill together")
    return whole


def _turned(mesh: Manifold) -> Manifold:
    """The same triangles, wound the other way."""
    written = mesh.to_mesh64()
    return _manifold(written.vert_properties, written.tri_verts[:, ::-1])


def _manifold(vertices: Array, faces: Indices) -> Manifold:
    return Manifold(Mesh64(np.array(vertices), np.array(faces, np.uint64, order="C")))
