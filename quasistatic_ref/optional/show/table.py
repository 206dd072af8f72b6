"""A trajectory as a table of pandas.

One row a step, by the time of its end; one column a number: ``delta_q.bunny/base.x`` by the name
of the coordinate, ``q.0`` by its entry (after the step), ``phi.3`` by the contact,
``wrench.3.f_n`` and ``alpha.3.x`` by the contact and the axis. Constants, Jacobians and the
quadratic programs stay arrays.
"""

from collections.abc import Sequence
from importlib import import_module
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.errors import InputError

if TYPE_CHECKING:
    from pandas import DataFrame

    from quasistatic_ref.simulate.trajectory import Trajectory

AXES = ("x", "y", "z")
COLUMNS = (
    "q", "delta_q", "q_bar_a", "phi", "alpha", "beta", "n", "d1", "d2", "point", "wrench", "lam",
    "lam_extra", "certificate", "worst_residual", "digits",
)  # fmt: skip


def data_frame(trajectory: "Trajectory") -> "DataFrame":
    """The trajectory as a pandas.DataFrame, its index being t [s].

    Raises
    ------
    InputError
        If pandas is not installed.
    """
    try:
        pandas = import_module("pandas")
    except ImportError:
        problem = "a table needs pandas: pip install 'quasistatic-ref[pandas]'"
        raise InputError(problem) from None
    columns = {}
    for name in COLUMNS:
        if name not in trajectory.arrays:
            continue
        array = trajectory[name][1:] if name == "q" else trajectory[name]
        last = array.shape[-1] if array.ndim > 1 else 0
        labels = _labels(name, last, trajectory.header.get("coordinates", ()))
        for index in np.ndindex(array.shape[1:]):
            parts = [*map(str, index[:-1]), labels[index[-1]]] if index else []
            columns[".".join([name, *parts])] = array[(slice(None), *index)]
    return pandas.DataFrame(columns, index=pandas.Index(trajectory["t"], name="t"))


def _labels(name: str, count: int, coordinates: Sequence[str]) -> Sequence[str]:
    """What the entries along the last axis are called."""
    if name == "delta_q" and len(coordinates) == count:
        return coordinates
    if name == "wrench":
        return ("f_d1", "f_d2", "f_n", "tau_n")
    return AXES if name in ("alpha", "beta", "n", "d1", "d2") else [str(i) for i in range(count)]
