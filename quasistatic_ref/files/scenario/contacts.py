"""The ``[shapes.NAME]`` and ``[contacts.NAME]`` tables of a scenario."""

import os
import re
from collections.abc import Mapping
from dataclasses import replace
from fnmatch import fnmatchcase
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.contact.distance import number_within
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import InputError, ScenarioError, about_field
from quasistatic_ref.files.clouds import point_cloud
from quasistatic_ref.files.mesh_files import mesh_path
from quasistatic_ref.files.scenario.bodies import BodyEntry
from quasistatic_ref.files.scenario.checks import checked_fields
from quasistatic_ref.files.scenario.scenario_table import CONTACT, SHAPE, WITHIN, fields_of, pose
from quasistatic_ref.files.scenario.world_solids import SOLIDS
from quasistatic_ref.files.text import decimal
from quasistatic_ref.model.rotation import rotation
from quasistatic_ref.model.system import Kinematics, System
from quasistatic_ref.quoting import known_names, suggestion
from quasistatic_ref.shapes.placed_shape import PlacedShape
from quasistatic_ref.text.table_reader import REQUIRED, TableReader
from quasistatic_ref.text.together import once

Shapes = dict[str, list[PlacedShape]]
METRES = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6}
WORLD = 0
"""Number of the world among the links."""
MOST_PAIRS = 50_000
"""Most pairs of a scenario."""


def placed_shapes(
    system: System, entries: Mapping[str, BodyEntry], world: TableReader, folder: Path
) -> Shapes:
    """Every name that ``[contacts]`` may use, with its shapes.

    A link has the collision shapes of its URDF, each of which has a name, too; a body's name means
    its cloud, or else its root link; a name from ``[shapes]`` is fixed in the world. A pattern such
    as ``hand/*`` means every link that it matches and that has shapes. ScenarioError if a name is
    taken.
    """
    named: Shapes = {}
    for name in world.names_left():
        named[name] = [world_shape(name, world.table(name), folder)]
    world.close()
    for i, link in enumerate(system.links):
        if i != WORLD:
            named[link] = [shape for shape in system.shapes if shape.link == i]
    named |= {shape.name: [shape] for shape in system.shapes}
    for name, entry in entries.items():
        if name in named:
            problem = "is also the name of a body; choose another name"
            raise ScenarioError(problem, field=f"shapes.{name}")
        root = system.link(name)
        if entry.cloud is None:
            named[name] = named[system.links[root]]
        else:
            read = partial(point_cloud, entry.cloud)
            cloud = once(os.path.realpath(entry.cloud), read)
            named[name] = [PlacedShape(name, root, np.eye(3), np.zeros(3), cloud)]
    return named


def world_shape(name: str, table: TableReader, folder: Path) -> PlacedShape:
    """One ``[shapes.NAME]`` table: exactly one solid, and where it stands.

    Parameters
    ----------
    name : str
    table : TableReader
    folder : Path
        Of the scenario.

    Raises
    ------
    InputError
        Naming the field.
    """
    t, rpy = pose(fields_of(table, SHAPE)("pose"))
    kinds = [kind for kind in table.names_left() if kind in SOLIDS]
    if len(kinds) != 1:
        raise table.error_about(
            "shape", f"must be exactly one of {', '.join(SOLIDS)}", table.names_left()
        )
    kind = SOLIDS[kinds[0]]
    sizes = table.table(kinds[0])
    arguments = {name: field.read(sizes, name) for name, field in kind.fields.items()}
    if "file" in arguments:
        with about_field(sizes.name("file")):  # a path that leads to nothing beside the folder
            arguments["file"] = mesh_path(arguments["file"], folder, is_of_file=False)
    try:
        shape = kind.made(**arguments)
    except InputError as error:
        error.field = sizes.name(error.field) if error.field in arguments else sizes.where
        raise
    sizes.close()
    table.close()
    return PlacedShape(name, WORLD, rotation(rpy), t, shape)


def contact_pairs(
    tables: TableReader, shapes: Shapes, start: Kinematics
) -> tuple[ContactPair, ...]:
    """The pairs of all ``[contacts.NAME]`` tables, in file order.

    A k that is a distance becomes a number where the scenario starts. ScenarioError if a table is
    wrong, or there are more than MOST_PAIRS.
    """
    pairs: list[ContactPair] = []
    for name in tables.names_left():
        table = tables.table(name)
        read = checked_fields(table, CONTACT)
        sides = [_side(table, key, read(key), shapes) for key in ("alpha", "beta")]
        rows = read("rows")
        mu_v = read("mu_v")
        if rows != 4 and "mu_omega" not in table:
            problem = "is missing; rows = 4 goes without torsional friction"
            raise table.error_about("mu_omega", problem)
        mu_omega = read("mu_omega", 0.0 if rows == 4 else REQUIRED)
        if rows == 4 and mu_omega > 0:
            problem = "has no effect with rows = 4; set rows = 6, or remove it"
            raise table.error_about("mu_omega", problem, mu_omega)
        within = _within(table)
        k = table.integer("k", 1, least=1) if within is None else 1
        hull = read("hull")
        count = len(pairs) + len(sides[0]) * len(sides[1])
        if count > MOST_PAIRS:
            problem = f"makes more pairs than {MOST_PAIRS} in this scenario; name fewer shapes"
            raise ScenarioError(problem, field=table.where, value=count)
        for alpha in sides[0]:
            for beta in sides[1]:
                label = f"{name}({alpha.name}, {beta.name})"
                with about_field(table.where):
                    pair = ContactPair(label, alpha, beta, mu_v, mu_omega, rows, k, hull)
                    if within is not None:
                        number = number_within(pair, start.R, start.t, within)
                        pair = replace(pair, k=number)
                    pairs.append(pair)
    tables.close()
    return tuple(pairs)


def _within(contact: TableReader) -> float | None:
    """The distance [m] of a k such as ``{ within = "5 mm" }``; None where k is no table."""
    if not isinstance(contact.peek("k"), dict):
        return None
    table = contact.table("k")
    checked_fields(table, WITHIN)
    text = table.take("within")
    length = re.fullmatch(r" *(\d[\d.eE-]*) *([a-z]+) *", text if isinstance(text, str) else "")
    if length is None or length[2] not in METRES:
        raise table.error_about(
            "within", f"must be a length in {', '.join(METRES)}, as '5 mm'", text
        )
    with about_field(table.name("within")):
        return decimal(length[1]) * METRES[length[2]]


def _side(table: TableReader, key: str, sides: Any, shapes: Shapes) -> list[PlacedShape]:
    placed: list[PlacedShape] = []
    for name in sides if isinstance(sides, list) else [sides]:
        if not isinstance(name, str):
            raise table.error_about(key, "must be a name or a list of names", sides)
        if any(c in name for c in "*?["):
            placed += _matching(table, key, name, shapes)
            continue
        if name not in shapes:
            problem = f"is not a body, link or shape of this scenario{suggestion(name, shapes)}"
            raise table.error_about(key, problem, name)
        if not shapes[name]:
            others = {one.name for more in shapes.values() for one in more}
            near = sorted(other for other in others if other.startswith(f"{name}/"))
            remedy = "add one, or give a cloud"
            if near:
                remedy = (
                    f"the body's shapes stand on other links: {known_names([f'{name}/*', *near])}"
                )
            raise table.error_about(key, f"has no collision shape; {remedy}", name)
        placed += shapes[name]
    if not placed:
        raise table.error_about(key, "must name at least one shape", sides)
    names = [shape.name for shape in placed]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise table.error_about(
            key, f"names {twice} twice, so its friction would count twice", sides
        )
    return placed


def _matching(table: TableReader, key: str, pattern: str, shapes: Shapes) -> list[PlacedShape]:
    """Shapes of all links that a pattern matches, in the order of the links."""
    single = {shape.name for matched in shapes.values() for shape in matched}
    links = [name for name in shapes if "/" in name and name not in single]
    names = [name for name in links if fnmatchcase(name, pattern)]
    if not names:
        raise table.error_about(key, "matches no link; a pattern looks like 'hand/*'", pattern)
    matched = [shape for name in names for shape in shapes[name]]
    if not matched:
        raise table.error_about(key, "matches no link with a collision shape", pattern)
    return matched
