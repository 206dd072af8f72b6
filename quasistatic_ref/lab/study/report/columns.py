"""The rows of a store as columns, chosen by what they say about themselves."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from quasistatic_ref.lab.study.measuring.grade import NOT_RUN, SOLVED
from quasistatic_ref.lab.study.store.rows import Row

FLAGS = ("warm", "feasible", "said_optimal", "said_infeasible", "wrong", "wrong_multipliers")
Columns = Mapping[str, np.ndarray]
Where = Mapping[str, str | bool | int]

TEXT = ("problem", "family", "interface", "solver", "setting", "mode", "units", "outcome",
        "claimed")  # fmt: skip


def columns_of(rows: Sequence[Row], limit: float) -> Columns:
    """Rows of solvers as columns, with the two conventions that every number of a report keeps.

    Parameters
    ----------
    rows : sequence of dict
    limit : float
        The study's time limit of a problem [s].

    Returns
    -------
    mapping of str to ndarray, shape (rows,)
        The fields of the rows, and ``way`` (interface:solver), ``who`` (solver, and behind an @
        the machine, where several were merged), ``label`` (interface:who); ``unit``, the problem
        with its repetition; ``called``, whether the call was made; ``digits``: those of delta_q
        that were delivered, 0 where the solver does not say that it solved the problem;
        ``seconds``: of the call, the time limit where the solver does not say so; ``own_setup`` and
        ``own_solver``: of set-up and of solving by its own account, ``iterations``:
        NaN where the solver reports none; ``net``.
    """
    columns = {name: np.array([row[name] for row in rows], dtype=np.str_) for name in TEXT}
    for name in FLAGS:
        columns[name] = np.array([row[name] for row in rows], dtype=bool)
    columns["repetition"] = np.array([row["repetition"] for row in rows], dtype=int)
    columns["machine"] = np.array([row.get("machine", "") for row in rows], dtype=np.str_)
    behind = [f"@{machine}" if machine else "" for machine in columns["machine"]]
    columns["who"] = np.strings.add(columns["solver"], np.array(behind, dtype=np.str_))
    columns["way"] = _joined(columns["interface"], columns["solver"])
    columns["label"] = _joined(columns["interface"], columns["who"])
    columns["unit"] = np.array(
        [f"{row['problem']}#{row['repetition']}" for row in rows], dtype=np.str_
    )
    solved = columns["outcome"] == SOLVED
    digits = _numbers([row["digits"]["delta_q"] for row in rows])
    net = _numbers([row["digits"]["net_wrench"] for row in rows])
    call = _numbers([row["seconds"]["call"] for row in rows])
    columns["solved"] = solved
    columns["called"] = columns["outcome"] != NOT_RUN
    columns["digits"] = np.where(solved & np.isfinite(digits), digits, 0.0)
    columns["net"] = np.where(solved & np.isfinite(net), net, 0.0)
    columns["seconds"] = np.where(solved & np.isfinite(call), call, limit)
    for name in ("setup", "solver"):
        columns[f"own_{name}"] = _numbers([row["seconds"][name] for row in rows])
    columns["warm_up"] = _numbers([row["seconds"]["warm_up"] for row in rows])
    columns["memory"] = _numbers([row["memory"] for row in rows])
    agrees = [row["clock_agrees"] is not False for row in rows]  # null: not compared
    columns["clock_agrees"] = np.array(agrees, dtype=bool)
    columns["iterations"] = _numbers([row["iterations"] for row in rows])
    return columns


def size(columns: Columns) -> int:
    """How many rows there are."""
    return len(columns["unit"])


def chosen(columns: Columns, where: Where) -> Columns:
    """The rows whose fields have these values."""
    keep = np.ones(size(columns), dtype=bool)
    for name, value in where.items():
        keep &= columns[name] == value
    return _kept(columns, keep)


def common(columns: Columns, by: Sequence[str] = ("label",)) -> Columns:
    """The rows on the problems that every solver was run on.

    Parameters
    ----------
    columns : mapping of str to ndarray
    by : sequence of str
        The fields that distinguish one solver from another. A solver without any call is left
        out; a call that a budget did not reach counts as not solved, which costs its own solver
        and no other.
    """
    if not size(columns):
        return columns
    one = _numbered(columns, by)
    columns = _kept(columns, np.isin(one, one[columns["called"]]))
    if not size(columns):
        return columns
    _, unit = np.unique(columns["unit"], return_inverse=True)
    one = _numbered(columns, by)
    there = np.zeros((one.max() + 1, unit.max() + 1), dtype=bool)
    there[one, unit] = True
    shared: np.ndarray = np.all(there, axis=0, keepdims=True)[0]
    return _kept(columns, shared[unit])


def groups(columns: Columns, by: Sequence[str]) -> Iterator[tuple[tuple[str, ...], Columns]]:
    """The rows in parts, by the values of some fields, in the order in which these first occur."""
    number = _numbered(columns, by)
    _, first = np.unique(number, return_index=True)
    for i in np.sort(first):
        key = tuple(str(columns[name][i]) for name in by)
        yield key, _kept(columns, number == number[i])


def matrix(columns: Columns, name: str, labels: Sequence[str]) -> np.ndarray:
    """One field, a row for each solver and a column for each problem that all were run on.

    Parameters
    ----------
    columns : mapping of str to ndarray
        As :func:`common` returns them, one setting only.
    name : str
    labels : sequence of str

    Returns
    -------
    ndarray, shape (len(labels), problems)
    """
    parts = [chosen(columns, {"label": label}) for label in labels]
    return np.array([part[name][np.argsort(part["unit"])] for part in parts])


def _joined(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.strings.add(np.strings.add(one, ":"), other)


def _numbers(values: Sequence[float | None]) -> np.ndarray:
    return np.array([np.nan if v is None else v for v in values], dtype=float)


def _kept(columns: Columns, keep: np.ndarray) -> Columns:
    return {name: column[keep] for name, column in columns.items()}


def _numbered(columns: Columns, by: Sequence[str]) -> np.ndarray:
    """A number for each row, equal where all of the fields are."""
    number = np.zeros(size(columns), dtype=int)
    for name in by:
        values, inverse = np.unique(columns[name], return_inverse=True)
        number = number * len(values) + inverse
    return np.unique(number, return_inverse=True)[1]
