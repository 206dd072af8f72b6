"""The solids that a ``[shapes.NAME]`` table can say: their fields, and the shape made of these."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

from quasistatic_ref.errors import ScenarioError, about_field
from quasistatic_ref.formats.declared import Field
from quasistatic_ref.model.readers.mesh_files import mesh_hull, mesh_path
from quasistatic_ref.shapes import placed_shape as shapes
from quasistatic_ref.step.data import Array


class Kind(NamedTuple):
    """One kind of solid.

    Parameters
    ----------
    fields : mapping of str to Field
    made : callable
        The shape of a scenario's folder, the table's place in the file and the fields by name.
    """

    fields: Mapping[str, Field]
    made: Callable[..., shapes.Shape]


def _mesh(folder: Path, where: str, file: str, scale: Array) -> shapes.Shape:
    if not (scale != 0).all():
        raise ScenarioError("must not be zero", field=f"{where}.scale", value=scale.tolist())
    with about_field(f"{where}.file"):
        path = mesh_path(file, folder, ())
    return mesh_hull(path, scale)


_SIZE = Field("three numbers", "edges, or axes, along x, y, z", "m",
              schema={"items": {"minimum": 0, "exclusiveMinimum": True}})  # fmt: skip
_RADIUS = Field("number", "radius", "m", above=0.0)
_ROUND = {
    "radius": _RADIUS,
    "length": Field("number", "length along z, without caps", "m", above=0.0),
}

SOLIDS: dict[str, Kind] = {
    "halfspace": Kind(
        {
            "normal": Field("three numbers", "out of the solid, of any length", "-"),
            "offset": Field("number", "the solid is normal . x <= offset: for a normal of "
                            "length 1 the height of its plane", "m", 0.0),
        },
        lambda _, __, normal, offset: shapes.HalfSpace(normal, offset),
    ),
    "box": Kind({"size": _SIZE}, lambda _, __, size: shapes.Box(size=size)),
    "sphere": Kind({"radius": _RADIUS}, lambda _, __, radius: shapes.Sphere(radius)),
    "cylinder": Kind(_ROUND, lambda _, __, radius, length: shapes.Cylinder(radius, length=length)),
    "capsule": Kind(_ROUND, lambda _, __, radius, length: shapes.Capsule(radius, length=length)),
    "cone": Kind(_ROUND, lambda _, __, radius, length: shapes.Cone(radius, length=length)),
    "ellipsoid": Kind({"size": _SIZE}, lambda _, __, size: shapes.Ellipsoid(size=size)),
    "mesh": Kind(
        {
            "file": Field("text", "file in the scenario's folder, whose convex hull is taken"),
            "scale": Field("three numbers", "along x, y, z; not 0", "-", (1.0, 1.0, 1.0),
                           schema={"items": {"not": {"enum": [0]}}}),
        },
        _mesh,
    ),
}  # fmt: skip
"""The kinds by the name of their table."""
