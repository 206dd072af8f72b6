"""The ``[shapes.NAME]`` tables of a scenario: solids that stand still."""

from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.fields import Fields
from quasistatic_ref.model.rotation import rotation
from quasistatic_ref.scenario.scenario_table import SHAPE, value
from quasistatic_ref.scenario.tables import pose
from quasistatic_ref.scenario.world_solids import SOLIDS
from quasistatic_ref.shapes import placed_shape as shapes

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
    kinds = [kind for kind in table.names() if kind in SOLIDS]
    if len(kinds) != 1:
        raise table.fail("shape", f"must be exactly one of {', '.join(SOLIDS)}", table.names())
    kind, sizes = SOLIDS[kinds[0]], table.table(kinds[0])
    given = {name: field.read(sizes, name) for name, field in kind.fields.items()}
    try:
        shape = kind.made(folder, sizes.where, **given)
    except InputError as error:
        error.field = error.field if error.field and "." in error.field else sizes.where
        raise
    sizes.close()
    table.close()
    return shapes.PlacedShape(name, WORLD, rotation(rpy), t, shape)
