"""A trajectory as tables of pandas, whose columns have names and units.

One wide table: a row a step, by the time of its end, and a column a number. One tidy table: a row a
step and contact.
"""

from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import Mask
from quasistatic_ref.optional.show.loads import shown_forces
from quasistatic_ref.parts import needed_package
from quasistatic_ref.quoting import no_formula
from quasistatic_ref.text.content import written_whole

if TYPE_CHECKING:
    from pandas import DataFrame

    from quasistatic_ref.simulate.record.trajectory import Trajectory

VECTORS: Final[Mapping[str, tuple[str, ...]]] = {
    **{name: tuple(f"{name}.{axis} [m]" for axis in "xyz") for name in ("alpha", "beta")},
    **{name: tuple(f"{name}.{axis} [-]" for axis in "xyz") for name in ("n", "d1", "d2")},
}
"""Columns of a contact's vectors, by array."""
SUMS: Final = ("normal force [N]", "friction [N]", "torque [N m]")
"""Columns of a pair, of sums over its contacts."""
STEP: Final = {"certificate": "certificate", "worst_residual": "worst residual [-]",
               "digits": "digits [-]"}  # fmt: skip
"""Columns of a step, by array."""
FORMATS: Final = (".csv", ".parquet")


def data_frame(trajectory: "Trajectory") -> "DataFrame":
    """A run as a data frame with one row for each step, indexed by the time t [s].

    ``arm/elbow [rad]`` and ``mug.z [m]`` are positions after the step, ``target arm/elbow [rad]``
    what they were to become, ``delta_q mug/base.z [m]`` the displacement in the step, and
    ``grip(mug, left).normal force [N]`` a sum over the contacts of that pair.

    Raises
    ------
    InputError
        If pandas is not installed.
    """
    pandas = _pandas()
    return pandas.DataFrame(_wide(trajectory), index=pandas.Index(trajectory["t"], name="t [s]"))


def contact_frame(trajectory: "Trajectory") -> "DataFrame":
    """A run as a data frame with one row for each contact of each step.

    Where the run does not know the forces of single contacts, as a light record, the columns say so
    by their names: ``f_n of lam [N]``.

    Raises
    ------
    InputError
        If pandas is not installed.
    """
    pandas = _pandas()
    pairs = trajectory.pair_names
    columns: dict[str, NDArray[Any]] = {
        "t [s]": np.repeat(trajectory["t"], len(pairs)),
        "pair": np.tile(pairs, trajectory.steps),
    }
    if trajectory.steps:
        columns |= {label: values.ravel() for label, values in _of_contacts(trajectory).items()}
    return pandas.DataFrame(columns)


def table_written(trajectory: "Trajectory", path: Path, option: str = "--table") -> Path:
    """Write a table as CSV or Parquet, by the name of the file.

    Parameters
    ----------
    trajectory : Trajectory
    path : Path
        Checked by :func:`check_table_path`.
    option : str
        ``--table`` for :func:`data_frame`, ``--contacts-table`` for :func:`contact_frame`.

    """
    frame = data_frame(trajectory) if option == "--table" else contact_frame(trajectory)
    if path.suffix == ".csv":
        frame = frame.rename(columns=no_formula)
        if "pair" in frame:
            frame["pair"] = [*map(no_formula, frame["pair"])]
        return written_whole(path, lambda file: frame.to_csv(file, mode="wb"))
    return written_whole(path, frame.to_parquet)


def check_table_path(path: Path, option: str = "--table") -> None:
    """Refuse the name of a table that cannot be written, before anything is done.

    Parameters
    ----------
    path : Path
    option : str
        By which it was given.

    Raises
    ------
    InputError
    """
    if path.suffix not in FORMATS:
        problem = f"must end in {' or '.join(FORMATS)}"
        raise InputError(problem, field=option, value=str(path))
    _pandas()
    if path.suffix == ".parquet":
        needed_package("pyarrow", "parquet", "a Parquet file")


def _wide(trajectory: "Trajectory") -> dict[str, NDArray[Any]]:
    """The columns of the wide table, shape (steps,)."""
    header = trajectory.header
    names = trajectory.header.positions
    columns = dict(zip(names, trajectory["q"][1:].T, strict=True))
    if not trajectory.steps:
        return columns
    targets = zip(names, trajectory["q_bar_a"].T, strict=False)  # q_a comes first in q
    columns |= {f"target {name}": values for name, values in targets}
    moves = zip(header.coordinates, header.units, trajectory["delta_q"].T, strict=True)
    columns |= {f"delta_q {name} [{unit}]": values for name, unit, values in moves}
    slots = np.array(trajectory.pair_names)
    for pair in dict.fromkeys(trajectory.pair_names):
        of_pair = slots == pair
        columns[f"{pair}.phi [m]"] = trajectory["phi"][:, of_pair].min(axis=1)
        columns |= _sums(trajectory, pair, of_pair)
    if header.extra:
        extra = zip(header.extra, trajectory["lam_extra"].T, strict=True)
        columns |= {f"lam of {name}": values for name, values in extra}
    return columns | {label: trajectory[name] for name, label in STEP.items()}


def _sums(trajectory: "Trajectory", pair: str, of_pair: Mask) -> dict[str, NDArray[Any]]:
    """Sums of the forces of a pair's contacts, shape (steps,) each; none where they are not known.

    Of f_n [N], of the lengths of (f_d1, f_d2) [N], and of the sizes of tau_n [N m].
    """
    try:
        f_1, f_2, f_n, torque = np.moveaxis(trajectory.forces[:, of_pair], -1, 0)
    except InputError:
        return {}
    sums = (f_n, np.hypot(f_1, f_2), np.abs(torque))
    labels = zip(SUMS, sums, strict=True)
    return {f"{pair}.{label}": each.sum(axis=1) for label, each in labels}


def _of_contacts(trajectory: "Trajectory") -> dict[str, NDArray[Any]]:
    """Columns of the table of contacts by name, shape (steps, n_c) each."""
    columns = {"point": trajectory["point"], "phi [m]": trajectory["phi"]}
    shown = [shown_forces(trajectory, k) for k in range(trajectory.steps)]
    wrenches = np.array([of_step.wrench for of_step in shown])
    vectors = [(trajectory[name], labels) for name, labels in VECTORS.items()]
    for array, labels in ((wrenches, shown[0].columns), *vectors):
        columns |= dict(zip(labels, np.moveaxis(array, -1, 0), strict=True))
    return columns


def _pandas() -> ModuleType:
    return needed_package("pandas", "pandas", "a table")
