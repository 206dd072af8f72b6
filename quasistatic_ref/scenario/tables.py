"""The names that each table of a scenario may hold: checked before any value is read.

So a misspelt name is reported as what it is, and not as the absence of the right one.
"""

from collections.abc import Collection
from typing import Any

import numpy as np

from quasistatic_ref.errors import ScenarioError
from quasistatic_ref.formats.fields import Fields
from quasistatic_ref.formats.quoting import known_names, nearest_name
from quasistatic_ref.scenario.scenario_table import POSE, TABLES, value
from quasistatic_ref.step.data import Array

ZERO = np.zeros(3)
NAMES = {kind: tuple(fields) for kind, fields in TABLES.items()}
"""Names by kind of table."""
NAMED = {"bodies": "urdf", "contacts": "alpha"}
"""Tables of tables, and a field without which none of theirs can be."""


def check_names(table: Fields, kind: str) -> None:
    """Refuse a name that this kind of table does not hold.

    Raises
    ------
    InputError
        Naming the nearest name of the table; or, if only another kind of table holds one that is
        near, that one and its table.
    """
    own = NAMES[kind]
    for name in table.names():
        if name not in own:
            near = nearest_name(name, own) or _inside(name, table) or _elsewhere(name, kind)
            raise table.fail(name, f"is unknown{near or ';'} {known_names(own)}", table.take(name))


def _inside(name: str, table: Fields) -> str:
    for outer in ("contacts", "bodies", "shapes"):
        inner = table.take(outer, {})
        if isinstance(inner, dict) and name in inner:
            return f"; did you mean '{outer}.{name}'?"
    return ""


def _elsewhere(name: str, kind: str) -> str:
    for other, names in NAMES.items():
        if other != kind and (near := nearest_name(name, names)):
            return near.replace("?", f" of {other}?")
    return ""


def pose(table: Fields, xyz: Array = ZERO) -> tuple[Array, Array]:
    """Origin [m] and roll, pitch, yaw [rad] of a table of these two, each of shape (3,)."""
    found = value(table, POSE, "xyz", xyz), value(table, POSE, "rpy")
    table.close()
    return found


def check_made(made: Collection[tuple[str, str]], tables: dict[str, Any]) -> None:
    """Refuse a body or a contact that changes alone have made, and have not made whole.

    Parameters
    ----------
    made : collection of (str, str)
        ``("contacts", "grp")`` for each table that a change led into and that was not there.
    tables : dict

    Raises
    ------
    ScenarioError
        Naming the nearest table that was there.
    """
    for kind, name in made:
        if kind in NAMED and NAMED[kind] not in tables[kind][name]:
            there = [other for other in tables[kind] if (kind, other) not in made]
            near = f"{nearest_name(name, there) or ';'} {known_names(there)}"
            raise ScenarioError(f"is no table of this file{near}", field=f"{kind}.{name}")
