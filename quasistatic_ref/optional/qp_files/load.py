"""The programs of a file, by the reader of its kind."""

from __future__ import annotations

import io
import pickle
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np

from quasistatic_ref.errors import InputError, about_file, check_kind
from quasistatic_ref.exact.qp.files import load_answer
from quasistatic_ref.exact.qp.program import FIELDS, QuadraticProgram, program_of
from quasistatic_ref.files.npz import npz_arrays
from quasistatic_ref.optional.qp_files.qps import qps_program
from quasistatic_ref.quoting import known_names, suggestion
from quasistatic_ref.text.content import bytes_read

BOUNDLESS: Final = 9e19
"""What a .mat file of the Maros-Meszaros set has, or more, where there is no limit."""
MOST_NUMBERS: Final = 2**24
"""Numbers that are read from a file: 128 MiB."""
MOST_ENTRIES: Final = {"linear": 2**28, "quadratic": 2**26}
"""Entries of P and of all rows, zeros included. Of a linear program these take no memory."""
REMEDIES: Final = {
    ".lp": "write the model as .qps",
    ".qplib": "write the model as .qps",
}


def load_qp(path: str | Path, name: str | None = None) -> QuadraticProgram:
    """The quadratic program of a file, which ``exact_qp`` takes whole.

    Parameters
    ----------
    path : str or Path
        ``.npz`` of ``qpsolvers.Problem.save``; ``.qps``, ``.mps``, or ``.sif`` without CUTEst's
        language; ``.mat`` of the Maros-Meszaros set, ``.parquet`` of qpbenchmark, or ``.json`` of
        :meth:`~quasistatic_ref.ExactQP.save`.
    name : str, optional
        Of a program of a Parquet file, which may hold several.

    Returns
    -------
    QuadraticProgram
        Its decimals as they are written, where the file is a text.

    Raises
    ------
    InputError
        Naming the file and what is wrong with it, or the package that reads it.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> path = Path(tempfile.mkdtemp()) / "answer.json"
    >>> _ = qr.exact_qp(np.eye(2), [-3.0, "-0.1"]).save(path)
    >>> qr.exact_qp(qr.load_qp(path)).x.tolist()
    [3.0, 0.1]
    """
    programs = file_programs(path)
    check_kind(name, str | None, "name", "the name of a program")
    if name is None and len(programs) == 1:
        return next(iter(programs.values()))
    of_names = {key.partition("/")[2] or key: program for key, program in programs.items()}
    if name in of_names:
        return of_names[name]
    if name is None:
        problem = f"holds several programs; give the name of one; {known_names(of_names)}"
    else:
        problem = f"holds no program {name!r}{suggestion(name, of_names)}"
    raise InputError(problem, file=path)


def file_programs(path: str | Path) -> dict[str, QuadraticProgram]:
    """All programs of a file by name: one, but of a Parquet file several.

    Parameters are those of :func:`load_qp`; InputError as there, but for several programs.
    """
    with about_file(path):
        path = Path(path)
        suffix = path.suffix.lower()
        if suffix not in READERS:
            remedy = REMEDIES.get(suffix, "save the program by qpsolvers.Problem.save")
            raise InputError(f"is none of {', '.join(READERS)}: {remedy}")
        return READERS[suffix](path)


def check_size(n: int, rows: int, *, linear: bool) -> None:
    """Refuse a program that is too large to be solved, before its zeros are formed.

    InputError if the file asks for more.
    """
    kind = "linear" if linear else "quadratic"
    if n * (n + rows) > MOST_ENTRIES[kind]:
        problem = f"has {n} variables and {rows} rows; of a {kind} program at most "
        raise InputError(f"{problem}{MOST_ENTRIES[kind]} entries are held")


def _json(path: Path) -> dict[str, QuadraticProgram]:
    try:
        return {path.stem: load_answer(path).problem}
    except InputError as error:
        if error.field == "format":
            problem = "is no file of ExactQP.save; give the arrays of others to exact_qp, or .npz"
            raise InputError(problem) from None
        raise


def _npz(path: Path) -> dict[str, QuadraticProgram]:
    arrays = npz_arrays(path, "a problem of qpsolvers", missing=_nothing())
    if not {"P", "q"} <= arrays.keys():
        raise InputError("is not a problem of qpsolvers: it has no P and q")
    return {path.stem: _of(arrays)}


def _of(table: Mapping[str, Any]) -> QuadraticProgram:
    constant = table.get("constant", 0.0)
    if isinstance(constant, np.ndarray) and constant.size == 1:  # as np.savez writes a number
        constant = constant.item()
    return program_of(*(table.get(f) for f in FIELDS), constant=constant)


def _nothing() -> frozenset[bytes]:
    """The bytes of ``.npy`` files of np.array(None), by every NumPy that writes them."""
    none = np.array(None)
    file = io.BytesIO()
    np.lib.format.write_array(file, none)
    head = file.getvalue()[: file.getvalue().index(b"\n") + 1]
    payloads = {pickle.dumps(none, protocol) for protocol in (2, 3, 4)}
    return frozenset(
        head + payload.replace(b"numpy._core.", package)
        for payload in payloads
        for package in (b"numpy._core.", b"numpy.core.")
    )


def _qps(path: Path) -> dict[str, QuadraticProgram]:
    program = qps_program(bytes_read(path).decode("utf-8", "replace"), check_size)
    return {path.stem: program}


def _mat(path: Path) -> dict[str, QuadraticProgram]:
    """Minimise 1/2 x'Px + q'x + r, l <= A x <= u, the last n rows of A being those of x."""
    package = _package("scipy.io", "scipy", "a .mat file")
    content = bytes_read(path)
    with _reading("a problem of the Maros-Meszaros set"):
        names = ("P", "q", "r", "A", "l", "u")
        table = package.loadmat(io.BytesIO(content), variable_names=names, spmatrix=False)
    others = {name for name, *_ in package.whosmat(io.BytesIO(content))} if "A" in table else {}
    if "h_u" in others or "x_u" in others:
        problem = "is a problem of another package; only P, q, r, A, l, u of the set are read"
        raise InputError(problem)
    for name in names:
        if name not in table and name != "r":
            raise InputError("is missing: this is no problem of the Maros-Meszaros set", field=name)
    (n, *_), (m, *_) = np.shape(table["P"]), np.shape(table["A"])
    check_size(n, m, linear=False)
    shapes = {"P": (n, n), "q": (n,), "r": (1,), "A": (m, n), "l": (m,), "u": (m,)}
    array = {name: _dense(table[name], name, shapes[name]) for name in table if name in shapes}
    A, low, high = array["A"], array["l"], array["u"]
    low = np.where(low < -BOUNDLESS, -np.inf, low)
    high = np.where(high > BOUNDLESS, np.inf, high)
    if m < n or not np.array_equal(A[m - n :], np.eye(n)):
        problem = "must end in a unit matrix, the bounds of its variables"
        raise InputError(problem, field="A", value=list(A.shape))
    rows, lb, ub = A[: m - n], low[m - n :], high[m - n :]
    low, high = low[: m - n], high[: m - n]
    equal = low == high
    G = np.concatenate([rows[~equal], -rows[~equal]])
    h = np.concatenate([high[~equal], -low[~equal]])
    arrays = {"P": array["P"], "q": array["q"], "G": G[h < np.inf], "h": h[h < np.inf]}
    arrays |= {"A": rows[equal], "b": low[equal], "lb": lb, "ub": ub}
    return {path.stem: _of(arrays | {"constant": float(array.get("r", np.zeros(1))[0])})}


def _dense(value: Any, name: str, shape: tuple[int, ...]) -> Any:
    """An array of a shape, whose stored indices are checked before it becomes dense."""
    if hasattr(value, "tocsc"):
        with _reading(f"{name} of a problem"):
            value.tocsc().check_format(full_check=True)
            value = value.toarray()
    flat = value.reshape(-1) if len(shape) == 1 else value
    if flat.shape != shape or flat.dtype.kind not in "iuf":
        words = " x ".join(map(str, shape))
        raise InputError(f"must be {words} real numbers", field=name, value=value.shape)
    return flat.astype(np.float64)


def _parquet(path: Path) -> dict[str, QuadraticProgram]:
    parquet = _package("pyarrow.parquet", "pyarrow", "a Parquet file")
    content = bytes_read(path)
    with _reading("a test set of qpbenchmark"):
        file = parquet.ParquetFile(io.BytesIO(content))
        groups = [file.metadata.row_group(k) for k in range(file.metadata.num_row_groups)]
        numbers = sum(one.column(j).num_values for one in groups for j in range(one.num_columns))
        # A dictionary holds what is equal once, whatever it unpacks to.
        rows = file.read().to_pylist() if numbers <= MOST_NUMBERS else None
    if rows is None:
        raise InputError("holds more numbers than are read; split it", value=numbers)
    if not rows:
        raise InputError("holds no program; write one for each row")
    programs: dict[str, QuadraticProgram] = {}
    for k, row in enumerate(rows):
        name = f"{path.stem}/{row.get('name')}"
        if not isinstance(row.get("name"), str) or name in programs:
            raise InputError("must be a text that no other row has", field=f"row {k}, name")
        try:
            programs[name] = _of_row(row)
        except InputError as error:
            error.field = f"row {k}, {error.field}"
            raise
    return programs


def _of_row(row: dict[str, Any]) -> QuadraticProgram:
    for field in FIELDS:
        value = row.get(field)
        if value is not None and not isinstance(value, list):
            raise InputError("must be a list of numbers", field=field, value=value)
    n = len(row.get("q") or [])
    for field, side in (("P", "q"), ("G", "h"), ("A", "b")):
        value, rows = row.get(field), len(row.get(side) or [])
        if value is not None:
            check_size(n, rows, linear=False)
            flat = np.array(value, dtype=object).ravel()
            if flat.size != n * rows:
                problem = f"must be {rows} x {n} numbers, row after row"
                raise InputError(problem, field=field, value=flat.size)
            row[field] = [flat[k * n : (k + 1) * n].tolist() for k in range(rows)]
    return _of({field: value for field, value in row.items() if value})


@contextmanager
def _reading(what: str) -> Iterator[None]:
    """Say what a file is not where a package that reads it fails, in whatever way."""
    try:
        with warnings.catch_warnings(action="ignore"):
            yield
    except MemoryError:
        raise
    except Exception:  # SciPy and pyarrow raise anything at a file that is something else
        raise InputError(f"is not {what}, or is spoilt") from None


def _package(module: str, package: str, what: str) -> Any:
    try:
        return import_module(module)
    except ImportError:
        raise InputError(f"{what} is read by {package}: pip install {package}") from None


READERS: Final[Mapping[str, Callable[[Path], dict[str, QuadraticProgram]]]] = {
    ".npz": _npz,
    ".qps": _qps,
    ".mps": _qps,
    ".sif": _qps,
    ".mat": _mat,
    ".parquet": _parquet,
    ".json": _json,
}
"""By an extension, in lower case or in upper case, what reads all programs of a file."""
