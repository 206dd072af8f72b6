"""A trajectory as tables of pandas, whose columns have names and units.

One wide table for looking at: a row a step, by the time of its end, and a column a number. Two
tidy ones for analysis: a row a step and coordinate, a row a step and contact.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import written_whole
from quasistatic_ref.parts import needed_package
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array

if TYPE_CHECKING:
    from pandas import DataFrame

    from quasistatic_ref.simulate.trajectory import Trajectory

CONTACT: Final[Mapping[str, tuple[str, ...]]] = {
    "phi": ("phi [m]",),
    "wrench": ("f_d1 [N]", "f_d2 [N]", "f_n [N]", "tau_n [N m]"),
    **{name: tuple(f"{name}.{axis} [m]" for axis in "xyz") for name in ("alpha", "beta")},
    **{name: tuple(f"{name}.{axis} [-]" for axis in "xyz") for name in ("n", "d1", "d2")},
}
"""Columns of a contact, by array."""
STEP: Final = {"certificate": "certificate", "worst_residual": "worst residual [-]",
               "digits": "digits [-]"}  # fmt: skip
"""Columns of a step, by array."""
FORMATS: Final = (".csv", ".parquet")


def data_frame(trajectory: "Trajectory") -> "DataFrame":
    """One row a step, its index being t [s].

    ``arm/elbow [rad]`` and ``mug.z [m]`` are positions after the step, ``target arm/elbow [rad]``
    what they were to become, ``delta_q mug/base.z [m]`` the displacement in the step, and
    ``grip(mug, left)/2.f_n [N]`` belongs to the third contact of that pair.

    Raises
    ------
    InputError
        If pandas is not installed.
    """
    pandas = _pandas()
    columns = dict(_wide(trajectory))
    return pandas.DataFrame(columns, index=pandas.Index(trajectory["t"], name="t [s]"))


def coordinate_frame(trajectory: "Trajectory") -> "DataFrame":
    """One row a step and entry of q: t, its name and unit, its value and its target.

    Raises
    ------
    InputError
        If pandas is not installed.
    """
    pandas = _pandas()
    names = _positions(trajectory)
    steps = trajectory.steps
    values = trajectory["q"][1:]
    targets = np.full((steps, len(names)), np.nan)
    if steps:
        given = trajectory["q_bar_a"]
        targets[:, : given.shape[1]] = given
    words, units = zip(*(name.removesuffix("]").split(" [") for name in names), strict=True)
    return pandas.DataFrame({
        "t [s]": np.repeat(trajectory["t"], len(names)),
        "coordinate": np.tile(words, steps),
        "unit": np.tile(units, steps),
        "value": values.ravel(),
        "target": targets.ravel(),
    })  # fmt: skip


def contact_frame(trajectory: "Trajectory") -> "DataFrame":
    """One row a step and contact: t, its pair, its point's number, and its numbers.

    Raises
    ------
    InputError
        If pandas is not installed.
    """
    pandas = _pandas()
    pairs = [slot.rpartition("/")[0] for slot in _slots(trajectory)]
    columns: dict[str, Any] = {
        "t [s]": np.repeat(trajectory["t"], len(pairs)),
        "pair": np.tile(pairs, trajectory.steps),
    }
    if trajectory.steps:
        columns["point"] = trajectory["point"].ravel()
        for name, labels in CONTACT.items():
            numbers = _contacts(trajectory, name).reshape(-1, len(labels))
            columns |= dict(zip(labels, numbers.T, strict=True))
    return pandas.DataFrame(columns)


def table_written(trajectory: "Trajectory", path: Path) -> Path:
    """Write the wide table as CSV or Parquet, by the name of the file.

    Raises
    ------
    InputError
        If the name ends otherwise, or what writes it is not installed.
    """
    check_table_path(path)
    frame = data_frame(trajectory)
    if path.suffix == ".csv":
        return written_whole(path, lambda file: frame.to_csv(file, mode="wb"))
    return written_whole(path, frame.to_parquet)


def check_table_path(path: Path) -> None:
    """Refuse the name of a table that cannot be written, before anything is done.

    Raises
    ------
    InputError
    """
    if path.suffix not in FORMATS:
        problem = f"must end in {' or '.join(FORMATS)}"
        raise InputError(problem, field="--table", value=str(path))
    _pandas()
    if path.suffix == ".parquet":
        needed_package("pyarrow", "parquet", "a Parquet file")


def _wide(trajectory: "Trajectory") -> Iterator[tuple[str, Array]]:
    names = _positions(trajectory)
    yield from zip(names, trajectory["q"][1:].T, strict=True)
    if not trajectory.steps:
        return
    targets = [f"target {name}" for name in names[: trajectory["q_bar_a"].shape[1]]]
    yield from zip(targets, trajectory["q_bar_a"].T, strict=True)
    header = trajectory.header
    units = header.get("units", ["m, rad"] * len(header["coordinates"]))
    moves = [f"delta_q {c} [{u}]" for c, u in zip(header["coordinates"], units, strict=True)]
    yield from zip(moves, trajectory["delta_q"].T, strict=True)
    ends = np.cumsum(cone(header["cone"]).counts(trajectory["rows"])).tolist()
    for i, (slot, end) in enumerate(zip(_slots(trajectory), ends, strict=True)):
        yield f"{slot}.point", trajectory["point"][:, i]
        for name, labels in CONTACT.items():
            numbers = _contacts(trajectory, name)[:, i].reshape(trajectory.steps, -1).T
            yield from zip((f"{slot}.{label}" for label in labels), numbers, strict=True)
        for row, lam in enumerate(trajectory["lam"][:, ([0, *ends])[i] : end].T):
            yield f"{slot}.lam_{row} [N s]", lam
    for name, lam in zip(header["extra"], trajectory.arrays.get("lam_extra", np.zeros(0)).T,
                         strict=True):  # fmt: skip
        yield f"lam of {name}", lam
    for name, label in STEP.items():
        yield label, trajectory[name]


def _contacts(trajectory: "Trajectory", name: str) -> Array:
    """An array of contacts; for wrenches, the forces where the record holds them."""
    forces = trajectory.arrays.get("forces") if name == "wrench" else None
    return np.asarray(trajectory[name] if forces is None else forces)


def _positions(trajectory: "Trajectory") -> list[str]:
    """Names of the entries of q; numbers, of a file that has no names."""
    count = trajectory["q"].shape[1]
    return list(trajectory.header.get("positions", [f"q.{i} [m, rad]" for i in range(count)]))


def _slots(trajectory: "Trajectory") -> list[str]:
    """Names of the places of contacts; numbers, of a file that has no names."""
    count = len(trajectory["rows"])
    return list(trajectory.header.get("slots", [f"contact/{i}" for i in range(count)]))


def _pandas() -> Any:
    return needed_package("pandas", "pandas", "a table")
