"""The ``[shapes.NAME]`` tables of a scenario: solids that stand still."""

from collections.abc import Callable
from pathlib import Path

from quasistatic_ref.errors import InputError, ScenarioError, about_field
from quasistatic_ref.fields import Fields
from quasistatic_ref.model import shapes
from quasistatic_ref.model.mesh_files import mesh_hull, mesh_path
from quasistatic_ref.model.rotation import rotation
from quasistatic_ref.simulate.scenario_table import SHAPE, TABLES, value
from quasistatic_ref.simulate.tables import pose
from quasistatic_ref.step.data import Array

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
    t, rpy = pose(value(table, SHAPE, "pose"))
    kinds = [kind for kind in table.names() if kind in _KINDS]
    if len(kinds) != 1:
        raise table.fail("shape", f"must be exactly one of {', '.join(_KINDS)}", table.names())
    sizes = table.table(kinds[0])
    given = {name: value(sizes, kinds[0], name) for name in TABLES[kinds[0]]}
    try:
        shape = _KINDS[kinds[0]](folder, sizes.where, **given)
    except InputError as error:
        error.field = error.field if error.field and "." in error.field else sizes.where
        raise
    sizes.close()
    table.close()
    return shapes.PlacedShape(name, WORLD, rotation(rpy), t, shape)


def _mesh(folder: Path, where: str, file: str, scale: Array) -> shapes.Solid:
    if not (scale != 0).all():
        raise ScenarioError("must not be zero", field=f"{where}.scale", value=scale.tolist())
    with about_field(f"{where}.file"):
        path = mesh_path(file, folder, ())
    return mesh_hull(path, scale)


_KINDS: dict[str, Callable[..., shapes.Solid]] = {
    "halfspace": lambda _, __, normal, offset: shapes.HalfSpace(normal, offset),
    "box": lambda _, __, size: shapes.Box(size / 2),
    "sphere": lambda _, __, radius: shapes.Sphere(radius),
    "cylinder": lambda _, __, radius, length: shapes.Cylinder(radius, length / 2),
    "capsule": lambda _, __, radius, length: shapes.Capsule(radius, length / 2),
    "cone": lambda _, __, radius, length: shapes.Cone(radius, length / 2),
    "ellipsoid": lambda _, __, size: shapes.Ellipsoid(size / 2),
    "mesh": _mesh,
}
