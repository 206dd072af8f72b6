"""Closed meshes: what they enclose, or where they are open, doubled or overlap."""

import numpy as np
import trimesh
from manifold3d import Manifold, Mesh64

from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import Array, Indices

DIGITS = 7
"""Digits of the extent to which corners at one place agree: a bit of a float32 is 6e-8 [-]."""
FLAT = 1e-12
"""Thickness over the extent, and volume over its cube, that are nothing but rounding [-]."""
TOUCHING = 1e-6
"""Common part of shells, over the volume, up to which they only touch [-]."""


def closed_mesh(vertices: Array, triangles: Indices, notes: list[str]) -> trimesh.Trimesh:
    """The mesh of vertices, (V, 3) [m], and triangles, (T, 3), wound outwards.

    Corners at one place are joined where the mesh is open without that, and triangles between
    fewer than three corners left out. Triangles that are wound against their neighbours, or
    inwards, are turned, which is added to `notes`. A shell within another is a cavity where it is
    wound the other way; one that is in no other is a part.

    Raises
    ------
    InputError
        If the mesh has a hole, an edge of more than two triangles, or shells that overlap, or it
        encloses nothing.
    """
    mesh = trimesh.Trimesh(vertices, triangles, process=False)
    corners = vertices[triangles.ravel()]
    extent = float(np.ptp(corners, axis=0).max())
    _check_encloses(np.linalg.matrix_rank(corners - corners.mean(axis=0), rtol=FLAT) == 3)
    if not mesh.is_watertight:
        digits = DIGITS - np.ceil(np.log10(extent))
        mesh.merge_vertices(digits_vertex=int(digits))
        mesh.update_faces(np.diff(np.sort(mesh.faces)).all(axis=1))
    _check_encloses(len(mesh.faces) > 0)
    edges, sides = np.unique(mesh.edges_sorted, axis=0, return_counts=True)
    _check_edges(
        mesh.vertices[edges[sides == 1]],
        "of one triangle: a hole; close it, or give the points of the mesh as a cloud",
    )
    _check_edges(
        mesh.vertices[edges[sides > 2]],
        "of more than two triangles: a doubled face, or parts that touch; take the second face "
        "away, or unite the parts",
    )
    written = mesh.faces.copy()
    with np.errstate(all="ignore"):  # the centre of mass of what has no volume
        trimesh.repair.fix_normals(mesh, multibody=not mesh.is_winding_consistent)
    _turn_inverted_parts(mesh)
    if turned := np.count_nonzero((mesh.faces != written).any(axis=1)):
        notes.append(f"{turned} triangles are wound inwards, or against their neighbours: turned")
    volume = np.linalg.det(mesh.triangles - corners.mean(axis=0)).sum() / 6
    _check_encloses(volume > FLAT * extent**3)
    _check_shells(mesh)
    return mesh


def _check_encloses(something: bool) -> None:
    if not something:
        problem = (
            "encloses nothing: its corners lie in a point, on a line or in a plane, or its sides "
            "on each other; give a closed mesh with a volume"
        )
        raise InputError(problem, field="mesh")


def _check_edges(ends: Array, problem: str) -> None:
    """Refuse a mesh with open edges; `ends` are theirs, shape (E, 2, 3) [m]."""
    if len(ends):
        x, y, z = 1e3 * ends[0].mean(axis=0)
        place = f"{len(ends)} edges, the first at ({x:.4g}, {y:.4g}, {z:.4g}) mm"
        raise InputError(f"has {place}, {problem}", field="mesh")


def _turn_inverted_parts(mesh: trimesh.Trimesh) -> None:
    """Turn shells that are in no other one and wound inwards, with all that is in them."""
    every = np.arange(len(mesh.faces))
    parts = trimesh.graph.connected_components(mesh.face_adjacency, nodes=every, min_len=1)
    shells = [mesh.submesh([part], append=True, repair=False) for part in parts]
    if len(shells) == 1 or all(shell.volume >= 0 for shell in shells):
        return
    faces = mesh.faces.copy()
    outermost: list[tuple[Manifold, bool]] = []
    for i in np.argsort([-abs(shell.volume) for shell in shells]).tolist():
        solid = _solid(shells[i])
        least = (1 - TOUCHING) * solid.volume()
        holders = [turned for other, turned in outermost if (other ^ solid).volume() >= least]
        turned = holders[0] if holders else shells[i].volume < 0
        if not holders:
            outermost.append((solid, turned))
        if turned:
            faces[parts[i]] = faces[parts[i]][:, ::-1]
    mesh.faces = faces


def _solid(shell: trimesh.Trimesh) -> Manifold:
    """What a shell encloses, whichever way it is wound."""
    faces = shell.faces if shell.volume >= 0 else shell.faces[:, ::-1]
    return Manifold(Mesh64(shell.vertices, np.ascontiguousarray(faces, dtype=np.uint64)))


def _check_shells(mesh: trimesh.Trimesh) -> None:
    """Refuse overlapping shells: their volumes must sum to the volume that they fill."""
    whole = Manifold()
    for shell in sorted(mesh.split(repair=False), key=lambda shell: -abs(shell.volume)):
        cavity = shell.volume < 0
        solid = _solid(shell)
        whole = whole - solid if cavity else whole + solid
    if abs(whole.volume() - mesh.volume) > TOUCHING * mesh.volume:
        problem = (
            f"has shells that overlap: their volumes sum to {1e6 * mesh.volume:.4g} cm^3, and "
            f"together they fill {1e6 * whole.volume():.4g} cm^3; unite parts, and wind a cavity "
            "inwards"
        )
        raise InputError(problem, field="mesh")
