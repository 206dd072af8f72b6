"""Solids, and all pairs of them, as the structures of solid.h and solids.h."""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.optional.fast.compiled.library import library
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.optional.fast.tracker.tracker import no_contacts
from quasistatic_ref.shapes import placed_shape as shapes
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.rounded import Rounded
from quasistatic_ref.step.data import Array, Indices, Mask
from quasistatic_ref.step.ordered import dot

KINDS = (
    shapes.Sphere, shapes.Capsule, shapes.Box, shapes.HalfSpace, shapes.Cylinder, ConvexMesh
)  # fmt: skip
"""Kinds of solids, as solid.h counts them."""

KNOWN = KINDS[:-1]
"""Those on which compiled code measures clouds."""

CORNERS = 64
"""The most of a mesh, unless on a half-space: CORNERS of solid.h."""

CROSSINGS = 1024
"""The most of a pair: LARGEST of solids.h."""


class Solid(Structure):
    """``Solid`` of solid.h: one of `KINDS`."""

    def __init__(self, shape: shapes.Shape) -> None:
        super().__init__("solid.h", "Solid")
        flat = polytope(shape)
        extent = shape.extent
        self.put(
            {
                "kind": next(i for i, kind in enumerate(KINDS) if isinstance(shape, kind)),
                "corners": shape.corner_count, "faces": 0, "edges": 0, "triangles": 0,
                "size": np.array(sizes(shape)),
                "extent": np.array([extent if np.isfinite(extent) else 0.0]),
            }
        )  # fmt: skip
        if isinstance(shape, ConvexMesh):
            self.put({"triangles": len(shape.triangles), "surface": surface(shape)})
        if flat is not None:
            self.put(
                {
                    "faces": len(flat.normals), "edges": len(flat.edges),
                    "vertices": flat.vertices, "normals": flat.normals, "offsets": flat.offsets,
                    "ends": flat.edges, "sides": flat.sides,
                }
            )  # fmt: skip


def sizes(shape: shapes.Shape) -> list[float]:
    """The four numbers [m; of a normal -] that solid.h wants of a solid."""
    match shape:
        case shapes.HalfSpace():
            return [*shape.normal.tolist(), shape.offset]
        case shapes.Cylinder():
            return [shape.radius, shape.half_length, 0.0, 0.0]
        case ConvexMesh():
            return [float(np.abs(shape.vertices).max()), 0.0, 0.0, 0.0]
        case Rounded():
            half_extents, ball = shape.core
            return [*half_extents.tolist(), ball]
        case _:
            return [0.0] * 4


def surface(mesh: ConvexMesh) -> Array:
    """``Triangle`` of solid.h for each triangle, shape (T, 34) [m, m^2; of a normal -]."""
    corners = mesh.vertices[mesh.triangles]
    ways = np.roll(corners, -1, axis=1) - corners
    inward = np.cross(mesh.normals[:, None], ways)
    fields = (mesh.normals, mesh.offsets, corners, ways, dot(ways, ways), inward)
    return np.column_stack([field.reshape(len(corners), -1) for field in fields])


@lru_cache(maxsize=256)
def solid(shape: shapes.Shape) -> Solid:
    """The structure of a shape, made once."""
    return Solid(shape)


def measured(pair: ContactPair) -> bool:
    """Whether compiled code measures a pair of solids, or of a cloud and a solid."""
    sides = pair.alpha.shape, pair.beta.shape
    if pair.has_cloud:
        return any(isinstance(side, KNOWN) for side in sides)
    if any(isinstance(side, shapes.HalfSpace) for side in sides):
        return all(isinstance(side, KINDS) for side in sides)
    if any(isinstance(side, ConvexMesh) and side.corner_count > CORNERS for side in sides):
        return False
    if any(isinstance(side, shapes.Sphere) for side in sides):
        return all(isinstance(side, KINDS) for side in sides)
    return all(polytope(side) is not None for side in sides)


class SolidPairs(Structure):
    """``SolidPairs`` of solids.h: the pairs of two solids among all pairs.

    Parameters
    ----------
    pairs : sequence of ContactPair
    R, t : ndarray of int, shape (L,)
        Addresses of each link's rotation, by columns, and of its origin.
    written : mapping
        The arrays of the contacts of all pairs, by their names in ``ClosestPoints``.
    """

    def __init__(
        self,
        pairs: Sequence[ContactPair],
        R: Indices,
        t: Indices,
        written: Mapping[str, Any],
    ) -> None:
        super().__init__("solids.h", "SolidPairs")
        mine = [measured(pair) and not pair.has_cloud for pair in pairs]
        self.solids = [
            [solid(pair.alpha.shape), solid(pair.beta.shape)] if own else []
            for pair, own in zip(pairs, mine, strict=True)
        ]
        a, b = (
            np.array([[one.address for one in both] or [0, 0] for both in self.solids], np.int64)
            .reshape(-1, 2)
            .T
        )
        count = np.array([pair.n_c for pair in pairs], np.int64)
        most = max((pair.corners for pair in pairs), default=0) + CROSSINGS + 1
        contact = np.dtype([("numbers", np.float64, 10), ("integers", np.int64, 2)])
        self.put(
            {
                "pairs": len(pairs), "R": R, "t": t, "a": a, "b": b,
                "link_a": np.array([pair.alpha.link for pair in pairs], np.int64),
                "link_b": np.array([pair.beta.link for pair in pairs], np.int64),
                "on_a": np.array([np.column_stack([p.alpha.R, p.alpha.t]) for p in pairs]),
                "on_b": np.array([np.column_stack([p.beta.R, p.beta.t]) for p in pairs]),
                "k": np.array([pair.k for pair in pairs], np.int64),
                "start": np.cumsum(count) - count, "count": count,
                "corners": np.array([pair.corners for pair in pairs], np.int64),
                "candidates": np.zeros(most * contact.itemsize // 8),
                "order": np.zeros(most, np.int64), "late": np.zeros(most, np.int64),
                "decided": np.zeros(len(pairs), np.int64),
                **{name: written[name] for name in ClosestPoints._fields},
            }
        )  # fmt: skip


class PosedSolids:
    """The closest points of solids at any poses.

    Parameters
    ----------
    pairs : sequence of ContactPair
        At least one.
    """

    def __init__(self, pairs: Sequence[ContactPair]) -> None:
        links = 1 + max(side.link for pair in pairs for side in (pair.alpha, pair.beta))
        n_c = sum(pair.n_c for pair in pairs)
        self.R = np.zeros((links, 3, 3))
        self.t = np.zeros((links, 3))
        self.written = no_contacts(n_c)
        link = np.arange(links)
        addresses = self.R.ctypes.data + 72 * link, self.t.ctypes.data + 24 * link
        self.pairs = SolidPairs(pairs, *addresses, self.written._asdict())
        self.find = library().solid_pairs

    def __call__(self, R: Array, t: Array) -> tuple[ClosestPoints, Mask]:
        """The contacts of all pairs, and which pairs' they are: those of the others are not set.

        Parameters
        ----------
        R, t : ndarray, shapes (L, 3, 3) and (L, 3)
            The links'.
        """
        self.R[:] = R[: len(self.R)].transpose(0, 2, 1)
        self.t[:] = t[: len(self.t)]
        self.find(self.pairs.address)
        found = ClosestPoints._make(field.copy() for field in self.written)
        return found, self.pairs["decided"] != 0
