"""The object-surface pairs of a folder: outlines, and the friction of the finger."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quasistatic_ref.errors import InputError, about_file
from quasistatic_ref.formats.files import json_read
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.lab.reality.outline import Outline
from quasistatic_ref.lab.reality.tables import table_read

FINGER = 0.00475
"""Radius of the finger of the MIT pushes [m]; of other data, a column of patches.csv."""

COLUMNS: Mapping[str, str] = {"mu_pusher_used": "[-] friction of the finger"}
MATRIX = tuple(f"A{i}{j}" for i in "123" for j in "123")
OPTIONAL: Mapping[str, str] = {
    "rho": "[m] length by which the published fit scales torques",
    "mu_pusher_fitted": "[-] friction of the finger that was fitted to pushes; not used",
    "samples": "[-] number of loads",
    "finger_radius": "[m] 0.00475 where it is not given",
    **dict.fromkeys(MATRIX, "[1/N^2, up to scale] published ellipsoid w' A w = 1"),
}


@dataclass(frozen=True, eq=False)
class Pair:
    """An object on a surface.

    Parameters
    ----------
    name : str
        surface/shape.
    outline : Outline
    mu_finger : float
        The friction of the finger [-].
    radius : float
        Of the finger [m].
    published : float or None
        mu_omega / mu_v of the published ellipsoid [m].
    """

    name: str
    outline: Outline
    mu_finger: float
    radius: float
    published: float | None


def pairs_read(folder: Path, only: Sequence[str] = ()) -> list[Pair]:
    """The pairs of ``patches.csv``, their outlines from ``shapes.json``; perhaps only some.

    Raises
    ------
    InputError
        If a file or a pair is missing, or a number is not usable.
    """
    path = folder / "patches.csv"
    table = table_read(path, COLUMNS, OPTIONAL)
    for name in only:
        if name not in table.pairs:
            problem = f"is not a pair of {path}{suggestion(name, table.pairs)}"
            raise InputError(problem, field="--sets", value=name)
    shapes = outlines_read(folder / "shapes.json")
    pairs = []
    for k, name in enumerate(table.pairs):
        if only and name not in only:
            continue
        if table.pairs.count(name) > 1:
            raise InputError("is given twice", file=path, field=name)
        shape = name.split("/")[1]
        if shape not in shapes:
            raise InputError("has no outline", file=folder / "shapes.json", field=shape)
        row = {key: float(values[k]) for key, values in table.numbers.items()}
        radius = row.get("finger_radius", FINGER)
        for key, value in (("mu_pusher_used", row["mu_pusher_used"]), ("finger_radius", radius)):
            if value < 0:
                raise InputError("must be >= 0", file=path, field=f"{name}, {key}", value=value)
        mu_finger = row["mu_pusher_used"]
        pairs.append(Pair(name, shapes[shape], mu_finger, radius, published_ratio(row)))
    return pairs


def outlines_read(path: Path) -> dict[str, Outline]:
    """Outlines by name: lists of vertices (x, y) in the object's frame [m]."""
    with about_file(path):
        fields = TableReader(json_read(path))
        return {name: Outline(fields.array(name, (None, 2))) for name in fields.names_left()}


def published_ratio(row: Mapping[str, float]) -> float | None:
    """mu_omega / mu_v [m] of a published ellipsoid: rho sqrt((A11 + A22) / (2 A33)).

    Its twist (v, rho omega) lies along A w of the load w = (f, tau / rho), so that
    (mu_omega / mu_v)^2 omega / v = tau / f holds with rho^2 A11 / A33 where A is diagonal; A11 and
    A22 differ by little. `row` is one of ``patches.csv`` [the columns' units]; None where it has
    no A.
    """
    if not {"rho", *MATRIX} <= set(row):
        return None
    return float(row["rho"] * np.sqrt((row["A11"] + row["A22"]) / (2 * row["A33"])))
