"""The ``[shapes.NAME]`` tables of a scenario: solids that stand still."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from quasistatic_ref.errors import InputError, about_field
from quasistatic_ref.fields import Fields
from quasistatic_ref.model import shapes
from quasistatic_ref.model.mesh_files import mesh_hull, mesh_path
from quasistatic_ref.model.rotation import rotation
from quasistatic_ref.simulate.tables import pose

WORLD = 0
"""Number of the world among the links."""


def world_shape(name: str, table: Fields, folder: Path) -> shapes.PlacedShape:
    """One ``[shapes.NAME]`` table: exactly one solid, and where it stands.

    Parameters
    ----------
    name : str
    table : Fields
    folder : Path
        Of the scenario, which a mesh must not leave.

    Raises
    ------
    InputError
        Naming the field.
    """
    t, rpy = pose(table.table("pose", {}))
    kinds = [kind for kind in table.names() if kind in _KINDS]
    if len(kinds) != 1:
        raise table.fail("shape", f"must be exactly one of {', '.join(_KINDS)}", table.names())
    sizes = table.table(kinds[0])
    try:
        shape = _KINDS[kinds[0]](sizes, folder)
    except InputError as error:
        error.field = error.field if error.field and "." in error.field else sizes.where
        raise
    sizes.close()
    table.close()
    return shapes.PlacedShape(name, WORLD, rotation(rpy), t, shape)


def _length(sizes: Fields, field: str) -> float:
    return sizes.number(field, above=0.0)


def _mesh(sizes: Fields, folder: Path) -> shapes.Solid:
    address = sizes.text("file")
    scale = sizes.array("scale", (3,), np.ones(3))
    if not (scale != 0).all():
        raise sizes.fail("scale", "must not be zero", scale.tolist())
    with about_field(sizes.name("file")):
        path = mesh_path(address, folder, ())
    return mesh_hull(path, scale)


_KINDS: dict[str, Callable[[Fields, Path], shapes.Solid]] = {
    "halfspace": lambda s, _: shapes.HalfSpace(s.array("normal", (3,)), s.number("offset", 0.0)),
    "box": lambda s, _: shapes.Box(s.array("size", (3,)) / 2),
    "sphere": lambda s, _: shapes.Sphere(_length(s, "radius")),
    "cylinder": lambda s, _: shapes.Cylinder(_length(s, "radius"), _length(s, "length") / 2),
    "capsule": lambda s, _: shapes.Capsule(_length(s, "radius"), _length(s, "length") / 2),
    "cone": lambda s, _: shapes.Cone(_length(s, "radius"), _length(s, "length") / 2),
    "ellipsoid": lambda s, _: shapes.Ellipsoid(s.array("size", (3,)) / 2),
    "mesh": _mesh,
}
