"""A scene that is written in Python in the words of a scenario file, as the tables of one."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np

from quasistatic_ref.errors import ScenarioError
from quasistatic_ref.files.scenario.overrides import own_value
from quasistatic_ref.files.scenario.scenario_table import FORMAT, VERSION
from quasistatic_ref.files.scenario.world_solids import solid_table
from quasistatic_ref.model.body import Body
from quasistatic_ref.shapes.placed_shape import Shape

HERE: Final = Path("scene.toml")
"""Where such a scene stands: its relative paths are those of the working folder."""


def scene_tables(scene: Mapping[str, Any]) -> dict[str, Any]:
    """The tables that a parser would have returned of the same scene in a file.

    Parameters
    ----------
    scene : mapping
        As a scenario file, ``{"h": 0.01, "bodies": {"block": {...}}, ...}``. A body may be a Body,
        or have one as its ``body``, whose fields its table then overrides; a shape may be a Shape,
        or a table with a Shape as its ``shape``; arrays of NumPy serve as lists.

    Raises
    ------
    ScenarioError
        If something is not a table, or a shape has no words in a scenario file.
    """
    tables = {"format": FORMAT, "version": VERSION, **scene}
    tables["bodies"] = {name: _body(name, one) for name, one in _named(tables, "bodies")}
    tables["shapes"] = {name: _shape(name, one) for name, one in _named(tables, "shapes")}
    return {str(name): own_value(name, value) for name, value in tables.items()}


def _named(tables: Mapping[str, Any], kind: str) -> list[tuple[str, Any]]:
    named = tables.get(kind, {})
    if not isinstance(named, Mapping):
        raise ScenarioError("must be a mapping of names to tables", field=kind, value=named)
    return list(named.items())


def _body(name: str, entry: Any) -> Any:
    table = {"body": entry} if isinstance(entry, Body) else entry
    if not isinstance(table, Mapping):
        return table
    word = "body" if "body" in table else "urdf"
    body = table.get(word)
    if word == "body" and not (isinstance(body, Body) and "urdf" not in table):
        problem = "must be a Body, in the place of urdf, which is a file or its text"
        raise ScenarioError(problem, field=f"bodies.{name}.body", value=type(body).__name__)
    if not isinstance(body, Body):
        return table
    words = {
        "urdf": body.urdf,
        "base": body.base,
        "actuated": body.actuated if isinstance(body.actuated, str) else list(body.actuated),
        "pose": {"xyz": np.asarray(body.xyz), "rpy": np.asarray(body.rpy)},
        "positions": dict(body.positions),
        "package_dirs": [str(folder) for folder in body.package_dirs],
    }
    return words | {key: value for key, value in table.items() if key != word}


def _shape(name: str, entry: Any) -> Any:
    table = {"shape": entry} if isinstance(entry, Shape) else entry
    if not isinstance(table, Mapping) or not isinstance(table.get("shape"), Shape):
        return table
    kind, sizes = solid_table(table["shape"], name)
    return {kind: sizes} | {key: value for key, value in table.items() if key != "shape"}
