"""A run of another program: a table of t and q, as CSV or npz."""

import csv
import io
from pathlib import Path
from typing import NamedTuple

import numpy as np

from quasistatic_ref.errors import InputError, about_file
from quasistatic_ref.formats.files import bytes_read, text_of
from quasistatic_ref.formats.npz import npz_arrays
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.step.arrays import Array

TIMES = 1e-6
"""How far a time may be from its step, over h [-]."""

SEVERAL = 10
"""Different numbers that need the last decimal of a file, if it was rounded to that."""


class OtherRun(NamedTuple):
    """States of a run, the first where it starts.

    Parameters
    ----------
    first : int
        Of which step the first state is the start [-].
    q : ndarray, shape (steps + 1, n_q)
        [m, rad, -]; quaternions and (cos, sin) of length one.
    resolution : float
        To which the file's numbers are rounded [m, rad, -]; 0 if they have all digits.
    """

    first: int
    q: Array
    resolution: float


def positions(scenario: Scenario) -> list[str]:
    """Names of the entries of q, without units."""
    joints = scenario.system.joints
    return [name.partition(" ")[0] for joint in joints for name in joint.positions]


def resolution(q: Array) -> float:
    """What the last digit of rounded numbers is worth [m, rad, -]; 0 if they are not rounded.

    Numbers of a run at rest are short without rounding: several have to need the last digit.
    """
    if np.array_equal(q, q.astype(np.float32)):
        return float(np.spacing(np.float32(np.abs(q).max(initial=1.0))))
    for decimals in range(3, 12):
        if np.array_equal(q, np.round(q, decimals)):
            last = np.unique(q[q != np.round(q, decimals - 1)])
            return 10.0**-decimals if len(last) >= SEVERAL else 0.0
    return 0.0


def other_run(path: Path, scenario: Scenario) -> OtherRun:
    """Read the run of a scene.

    Where the first time is h, the start is that of the scenario.

    Parameters
    ----------
    path : Path
        ``.npz`` with ``t``, shape (states,), and ``q``, shape (states, n_q), or one state more; or
        a table in CSV, a column ``t`` and one for each entry of q.
    scenario : Scenario

    Raises
    ------
    InputError
        If it is none, its times are not those of steps, or its columns are others.
    """
    with about_file(path):
        t, q = _of_npz(path) if path.suffix == ".npz" else _of_csv(path, scenario)
        system = scenario.system
        if q.ndim != 2 or q.shape[1] != system.n_q or not len(q):
            raise InputError(f"must be states of {system.n_q} numbers", field="q", value=q.shape)
        if t.shape not in ((len(q),), (len(q) - 1,)):
            raise InputError(f"must be {len(q)} times", field="t", value=t.shape)
        if len(t) == len(q) - 1:  # a trajectory's: the end of each step
            t = np.append(t[:1] - scenario.h, t)
        steps = np.round(t / scenario.h)
        off = np.abs(t - steps * scenario.h) > TIMES * scenario.h * np.maximum(1, steps)
        if off.any() or not np.isfinite(t).all() or (np.diff(steps) != 1).any() or steps[0] < 0:
            problem = f"must grow by h = {scenario.h:g} s from state to state, in whole steps"
            raise InputError(problem, field="t", value=t[:3].tolist())
        states = [system.normalised(one) for one in q]
        first = int(steps[0])
        if first == 1:
            states.insert(0, system.q_start)
            first = 0
    return OtherRun(first, np.array(states), resolution(q))


def _of_npz(path: Path) -> tuple[Array, Array]:
    arrays = npz_arrays(path, "a run: an .npz file of t and q")
    for name in ("t", "q"):
        if name not in arrays:
            raise InputError("is missing", field=name)
    return np.asarray(arrays["t"], np.float64), np.asarray(arrays["q"], np.float64)


def _of_csv(path: Path, scenario: Scenario) -> tuple[Array, Array]:
    rows = [row for row in csv.reader(io.StringIO(text_of(bytes_read(path), path))) if row]
    if len(rows) < 2:
        raise InputError("is not a run: a table of t and q, its first row the names of the columns")
    head = [name.strip().partition(" [")[0] for name in rows[0]]
    columns = []
    for name in ("t", *positions(scenario)):
        if name not in head:
            problem = f"is not among its columns{suggestion(name, head)}"
            raise InputError(problem, field=name)
        columns.append(head.index(name))
    numbers = np.empty((len(rows) - 1, len(columns)))
    for i, row in enumerate(rows[1:]):
        for j, column in enumerate(columns):
            try:
                numbers[i, j] = float(row[column])
            except (ValueError, IndexError):
                field = f"row {i + 2}, {head[column]}"
                value = row[column] if column < len(row) else None
                raise InputError("must be a number", field=field, value=value) from None
    return numbers[:, 0], numbers[:, 1:]
