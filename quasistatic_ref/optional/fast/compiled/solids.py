"""Solids as the structure of solid.h."""

from functools import lru_cache

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.solids.polytope import polytope
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.shapes import placed_shape as shapes
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.rounded import Rounded
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.ordered import dot

KINDS = (
    shapes.Sphere, shapes.Capsule, shapes.Box, shapes.HalfSpace, shapes.Cylinder, ConvexMesh
)  # fmt: skip
"""Kinds of solids, as solid.h counts them."""

CORNERS = 64
"""The most of a mesh, unless on a half-space: CORNERS of solid.h."""


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
    """Whether compiled code measures a pair of a cloud and a solid, or of two that touch once."""
    sides = pair.alpha.shape, pair.beta.shape
    if pair.has_cloud:
        solid = next(side for side in sides if not isinstance(side, shapes.PointCloud))
        return isinstance(solid, KINDS) and solid.corner_count <= CORNERS
    if pair.n_c > 1:
        return False
    if any(isinstance(side, shapes.HalfSpace) for side in sides):
        return all(isinstance(side, KINDS) for side in sides)
    if any(isinstance(side, ConvexMesh) and side.corner_count > CORNERS for side in sides):
        return False
    if any(isinstance(side, shapes.Sphere) for side in sides):
        return all(isinstance(side, KINDS) for side in sides)
    return all(polytope(side) is not None for side in sides)
