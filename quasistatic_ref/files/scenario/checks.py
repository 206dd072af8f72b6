"""What is refused of a scenario as a whole: unknown names, numbers out of this world, dead pairs.

The names of each table are checked before any value is read, so a misspelt name is reported as what
it is, and not as the absence of the right one.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ScenarioError, about_field
from quasistatic_ref.files.scenario.overrides import ESSENTIAL
from quasistatic_ref.files.scenario.scenario_table import (
    FINDINGS,
    LIMITS,
    SOLVER,
    TABLES,
    fields_of,
)
from quasistatic_ref.model.system import System
from quasistatic_ref.quoting import known_names, nearest_name
from quasistatic_ref.simulate.finding import check_finding_name
from quasistatic_ref.simulate.limits import Limits
from quasistatic_ref.text.table_reader import TableReader
from quasistatic_ref.tolerances import LARGE

DEEPEST = 100
"""Most tables and lists in one another; none of a scenario are deeper than ten."""

WELDED: Final = 1e-12
"""Largest relative velocity, per unit of any coordinate [-], of two links that count as one.

Chains of rotations leave 1e-15 a link; a joint between them moves one of them by 1."""


def ignored_findings(table: TableReader) -> tuple[str, ...]:
    """Names of findings that a table [findings] ignores; ScenarioError if one is unknown."""
    names = tuple(checked_fields(table, FINDINGS)("ignore"))
    for name in names:
        with about_field(table.name("ignore")):
            check_finding_name(name)
    return names


def run_fields(read: Callable[..., Any], solver: TableReader) -> dict[str, Any]:
    """The fields of a :class:`.Scenario` that say how it runs; ``backend`` may be None.

    Parameters
    ----------
    read : callable
        The fields at the top.
    solver : TableReader
        The table [solver].
    """
    of_solver = checked_fields(solver, SOLVER)
    of_limits = checked_fields(read("limits"), LIMITS)
    return {
        **{name: read(name) for name in ("h", "steps", "record", "fast")},
        **{name: of_solver(name) for name in ("backend", "accuracy", "certify")},
        "limits": Limits(of_limits("penetration"), of_limits("reach")),
        "ignored_findings": ignored_findings(read("findings")),
    }


def checked_fields(table: TableReader, kind: str) -> Callable[..., Any]:
    """The fields of a table, after a check that each name in the table is one of them.

    Raises
    ------
    InputError
        Naming the nearest name of the table; or, if only another kind of table holds one that is
        near, that one and its table.
    """
    known = TABLES[kind]
    for name in table.names_left():
        if name not in known:
            near = nearest_name(name, known) or _inside(name, table)
            near = near or _elsewhere(name, kind, table)
            raise table.error_about(
                name, f"is unknown{near or ';'} {known_names(known)}", table.take(name)
            )
    return fields_of(table, kind)


def _inside(name: str, table: TableReader) -> str:
    for outer in ("contacts", "bodies", "shapes"):
        inner = table.take(outer, {})
        if isinstance(inner, dict) and name in inner:
            return f"; did you mean '{outer}.{name}'?"
    return ""


def _elsewhere(name: str, kind: str, table: TableReader) -> str:
    for other, names in TABLES.items():
        if other != kind and (near := nearest_name(name, names)):
            return near.replace("?", f" of {other}{_as_setting(near, other, table)}?")
    return ""


def _as_setting(near: str, other: str, table: TableReader) -> str:
    """How a setting names a field of another table, such as that of ``[contacts.NAME]``."""
    kind, dot, name = other.strip("[]").partition(".")
    if not dot or other.startswith("[["):
        return ""
    inner = table.fields.get(kind)
    if name == "NAME" and isinstance(inner, dict) and inner:
        name = next(iter(inner))
    _, field, _ = near.split("'")
    return f', as a setting "{kind}.{name}.{field}"'


def check_made(made: Mapping[tuple[str, str], str], tables: dict[str, Any]) -> None:
    """Refuse a change whose dotted key names a body or contact table that does not exist.

    Parameters
    ----------
    made : mapping of (str, str) to str
        The key of the change by ``("contacts", "grp")``, for each table that was not there.
    tables : dict

    Raises
    ------
    ScenarioError
        Naming the change, and the nearest table that was there.
    """
    for (kind, name), key in made.items():
        if kind in ESSENTIAL and ESSENTIAL[kind] not in tables[kind][name]:
            existing = [other for other in tables[kind] if (kind, other) not in made]
            near = f"{nearest_name(name, existing) or ';'} {known_names(existing)}"
            raise ScenarioError(f"{kind}.{name} is no table of the scenario{near}", field=key)


def check_sizes(value: Any, name: str = "", depth: int = 0) -> None:
    """Refuse numbers so large that their products leave the range of float64, and deep tables.

    Parameters
    ----------
    value : object
        As parsed. What is not finite is left to the field's own reader.
    name : str
        Dotted name of the value.
    depth : int
        In how many tables and lists it stands.

    Raises
    ------
    ScenarioError
    """
    if depth > DEEPEST:
        problem = f"is nested deeper than {DEEPEST} tables and lists"
        raise ScenarioError(problem, field=name.partition(".")[0].partition("[")[0])
    if isinstance(value, dict):
        for key, inner in value.items():
            check_sizes(inner, f"{name}.{key}" if name else key, depth + 1)
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            place = name if isinstance(inner, int | float) else f"{name}[{i}]"
            check_sizes(inner, place, depth + 1)
    elif isinstance(value, int | float) and LARGE < abs(value) < float("inf"):
        raise ScenarioError(f"must be at most {LARGE:g}", field=name, value=value)


def check_motion(system: System, pairs: Sequence[ContactPair]) -> None:
    """Refuse a system without coordinates, and pairs whose two sides never move apart.

    Raises
    ------
    ScenarioError
        If there are no coordinates at all, or a pair's two links never move relative to each
        other, so that its rows are zero.
    """
    if not system.n_v:
        problem = 'no body can move; give one of them base = "floating", or a URDF with joints'
        raise ScenarioError(problem, field="bodies")
    kinematics = system.kinematics(system.q_start)
    moves = system.column_map.moves
    for pair in pairs:
        a = pair.alpha.link
        b = pair.beta.link
        scale = 1 + np.abs(kinematics.t[[a, b]]).max()
        # Of bodies extended to the world's origin: two links move as one if this is zero.
        twists = system.column_map.of_coordinates(kinematics.columns * (moves[a] - moves[b]))
        if np.abs(twists).max() <= WELDED * scale:
            problem = "its two sides cannot move relative to each other, so it has no effect"
            names = {system.links[link].partition("/")[0] for link in (a, b)}
            still = [body.name for body in system.bodies if body.base == "fixed"]
            if fixed := [name for name in still if name in names]:
                problem += f'; if {fixed[-1]} is to move freely, give it base = "floating"'
            else:
                problem += "; leave it out"
            raise ScenarioError(problem, field=f"contacts.{pair.name}")
