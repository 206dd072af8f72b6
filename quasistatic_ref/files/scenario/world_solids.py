"""The solids that a ``[shapes.NAME]`` table can say: their fields, and the shape made of these."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from quasistatic_ref.errors import ScenarioError
from quasistatic_ref.files.mesh_files import mesh_hull
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    Shape,
    Sphere,
)
from quasistatic_ref.text.declared import Field
from quasistatic_ref.text.json_text import plain


class Kind(NamedTuple):
    """One kind of solid that a scenario's table can hold.

    Parameters
    ----------
    fields : mapping of str to Field
    made : callable
        The shape of the fields by name, `file` being a path.
    """

    fields: Mapping[str, Field]
    made: Callable[..., Shape]


def _mesh(file: Path, scale: Array) -> Shape:
    if not (scale != 0).all():
        raise ScenarioError("must not be zero", field="scale", value=scale.tolist())
    return mesh_hull(file, scale)


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
        HalfSpace,
    ),
    "box": Kind({"size": _SIZE}, Box),
    "sphere": Kind({"radius": _RADIUS}, Sphere),
    "cylinder": Kind(_ROUND, Cylinder),
    "capsule": Kind(_ROUND, Capsule),
    "cone": Kind(_ROUND, Cone),
    "ellipsoid": Kind({"size": _SIZE}, Ellipsoid),
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


def solid_table(shape: Shape, name: str) -> tuple[str, dict[str, Any]]:
    """Kind and sizes of a solid called `name`, as its table says them.

    Raises
    ------
    ScenarioError
        If no table says such a shape.
    """
    if shape.kind not in SOLIDS:
        kind = type(shape).__name__
        problem = f"is a {kind} that no file holds; write it as a mesh, and load that"
        raise ScenarioError(problem, field=name)
    return shape.kind, plain(shape.sizes)
