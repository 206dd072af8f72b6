"""The solids that a ``[shapes.NAME]`` table can say: their fields, and the shape made of these."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from quasistatic_ref.errors import ScenarioError, about_field
from quasistatic_ref.formats.declared import Field
from quasistatic_ref.model.readers.mesh_files import mesh_hull, mesh_path
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes import placed_shape as shapes


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
        path = mesh_path(file, folder, is_of_file=False)  # nothing beside it
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


def solid_table(shape: shapes.Shape, name: str) -> tuple[str, dict[str, Any]]:
    """Kind and sizes of a solid called `name`, as its table says them.

    Raises
    ------
    ScenarioError
        If no table says such a shape.
    """
    if isinstance(shape, shapes.HalfSpace):
        return "halfspace", {"normal": shape.normal.tolist(), "offset": shape.offset}
    if isinstance(shape, shapes.Sphere):
        return "sphere", {"radius": shape.radius}
    if isinstance(shape, shapes.Box):
        return "box", {"size": (2 * shape.half_extents).tolist()}
    if isinstance(shape, shapes.Ellipsoid):
        return "ellipsoid", {"size": (2 * shape.half_axes).tolist()}
    if isinstance(shape, shapes.Cylinder | shapes.Capsule | shapes.Cone):
        sizes = {"radius": shape.radius, "length": 2 * shape.half_length}
        return type(shape).__name__.lower(), sizes
    problem = f"is a {type(shape).__name__} that no file holds; write it as a mesh, and load that"
    raise ScenarioError(problem, field=name)
