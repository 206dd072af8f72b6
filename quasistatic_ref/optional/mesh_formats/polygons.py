"""Faces of meshes as triangles: fans where these fill a face, ears where they would not."""

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices, Mask

GRAIN = 1e-6
"""Area outside of a face, over the square of its extent, that is nothing but rounding [-]."""


def triangles_of_faces(vertices: Array, corners: Indices, sizes: Indices) -> Indices:
    """Triangles of faces, of which none lies outside of its face.

    A fan around the first corner fills every convex face. The fan of a face with a notch, or with a
    hole that is cut open, may cover the notch twice; such a face is cut by ears in its plane.

    Parameters
    ----------
    vertices : ndarray, shape (V, 3)
        [any unit].
    corners : ndarray of int, shape (C,)
        Numbers of the corners of all faces, one face after the other.
    sizes : ndarray of int, shape (F,)
        How many corners each face has, at least three.

    Returns
    -------
    ndarray of int, shape (C - 2 F, 3)
        Face after face, wound as the face is.
    """
    triangles = fans_of_faces(corners, sizes)
    if (sizes == 3).all() or corners.min() < 0 or corners.max() >= len(vertices):
        return triangles  # a number of no vertex is refused where all is read
    first = np.cumsum(sizes) - sizes
    for face in np.flatnonzero(_overlaps(vertices[triangles], sizes)).tolist():
        outline = corners[first[face] : first[face] + sizes[face]]
        start = first[face] - 2 * face
        triangles[start : start + sizes[face] - 2] = outline[_ears(vertices[outline])]
    return triangles


def fans_of_faces(corners: Indices, sizes: Indices) -> Indices:
    """Each face as a fan around its first corner, shape (T, 3)."""
    counts = sizes - 2
    begins = np.repeat(np.cumsum(sizes) - sizes, counts)
    place = np.arange(len(begins)) - np.repeat(np.cumsum(counts) - counts, counts)
    triangles = np.stack([begins, begins + place + 1, begins + place + 2], axis=1)
    return np.asarray(corners[triangles])


def _overlaps(fans: Array, sizes: Indices) -> Mask:
    """Whether the fan of each face, all in shape (T, 3, 3), has triangles wound the other way."""
    starts = np.cumsum(sizes - 2) - (sizes - 2)
    with np.errstate(invalid="ignore", over="ignore"):  # what is not finite is no overlap
        first, second = np.moveaxis(fans[:, 1:] - fans[:, :1], 1, 0)
        areas = np.cross(first, second) / 2
        normals = np.repeat(np.add.reduceat(areas, starts), sizes - 2, axis=0)
        length = np.linalg.norm(normals, axis=1)
        extent = np.maximum.reduceat(np.vecdot(first, first), starts)
        grain = GRAIN * np.repeat(extent, sizes - 2)
        wound_back = (np.vecdot(areas, normals) < -grain * length) & (length > grain)
        return np.asarray(np.logical_or.reduceat(wound_back, starts))


def _ears(outline: Array) -> Indices:
    """Triangles, shape (n - 2, 3), of a face with corners of shape (n, 3), by ears."""
    import manifold3d  # where no face has a notch, nothing loads it

    edges = outline - outline[0]
    normal = np.cross(edges[:-1], edges[1:]).sum(axis=0)
    axis = int(abs(normal).argmax())
    flat = np.delete(edges, axis, axis=1)
    if (normal[axis] < 0) != (axis == 1):  # seen from below; without y, a turn looks reversed
        flat[:, 0] *= -1
    loops = _loops(outline)
    ears = manifold3d.triangulate([flat[loop] for loop in loops])
    triangles = np.zeros((len(outline) - 2, 3), np.int64)  # what a spike leaves over has no area
    triangles[: len(ears)] = np.concatenate(loops)[ears]
    return triangles


def _loops(outline: Array) -> list[Indices]:
    """Numbers of the corners of a face around it and around each hole.

    A hole is joined to the outline by a cut, whose two sides have the same ends.
    """
    _, place = np.unique(outline, axis=0, return_inverse=True)
    places = place.tolist()
    left = [list(range(len(places)))]
    loops: list[Indices] = []
    while left:
        loop = left.pop()
        ends = zip(loop, loop[1:] + loop[:1], strict=True)
        sides = {(places[a], places[b]): k for k, (a, b) in enumerate(ends)}
        cuts = sorted((k, sides[b, a]) for (a, b), k in sides.items() if (b, a) in sides)
        if cuts:
            there, back = cuts[0]
            left += [loop[there + 1 : back], loop[back + 1 :] + loop[:there]]
        elif len(loop) > 2:
            loops.append(np.array(loop))
    return loops
