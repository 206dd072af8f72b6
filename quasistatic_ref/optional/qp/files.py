"""Quadratic programs of others in files, and our own files of programs with their answers."""

from __future__ import annotations

import io
import pickle
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np

from quasistatic_ref.errors import InputError, about_file
from quasistatic_ref.files.content import json_read
from quasistatic_ref.files.npz import npz_arrays
from quasistatic_ref.files.table_reader import TableReader
from quasistatic_ref.optional.qp.answer import (
    QP_FORMAT,
    VERSION,
    Answer,
    ExactQP,
    QPInfeasible,
    QPNotConvex,
    QPUnbounded,
)
from quasistatic_ref.optional.qp.program import FIELDS, NO_LIMIT, QuadraticProgram, program_of

SUFFIXES: Final = (".npz", ".mat", ".parquet", ".json")
BOUNDLESS: Final = 9e19
"""What a .mat file of the Maros-Meszaros set has, or more, where there is no limit."""


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


def load_qp(path: str | Path) -> dict[str, QuadraticProgram]:
    """The programs of a file by name: one, but of a Parquet file several.

    Parameters
    ----------
    path : str or Path
        ``.npz`` of ``qpsolvers.Problem.save``, ``.mat`` of the Maros-Meszaros set, ``.parquet`` of
        qpbenchmark, or ``.json`` of :meth:`~quasistatic_ref.ExactQP.save`.

    Raises
    ------
    InputError
        Naming the file and what is wrong with it, or the package that reads it.
    """
    path = Path(path)
    if path.suffix not in SUFFIXES:
        raise InputError(f"is none of {', '.join(SUFFIXES)}", file=path)
    read = dict(zip(SUFFIXES, (_npz, _mat, _parquet, _json), strict=True))
    with about_file(path):
        tables = read[path.suffix](path)
        return {name: program_of(*(table.get(f) for f in FIELDS)) for name, table in tables.items()}


def load_answer(path: str | Path) -> Answer:
    """A file of ``save``: nothing of what it claims is believed until it is verified.

    Raises
    ------
    InputError
        Naming the file, the field and the value.
    """
    with about_file(path):
        return _answer(TableReader(json_read(path)))


def _answer(top: TableReader) -> Answer:
    top.check_format(QP_FORMAT, VERSION)
    arrays = [_limits(field, top.take(field)) for field in FIELDS]
    program = program_of(*arrays, constant=top.take("constant"))
    status = top.text("status", choices=("optimal", "infeasible", "unbounded", "not convex"))
    answer: Answer
    if status == "infeasible":
        table = top.table("farkas")
        exact = {name: table.text(name) for name in table.names_left()}
        answer = QPInfeasible(program, exact)
    elif status == "unbounded":
        answer = QPUnbounded(program, top.words("x"), top.words("direction"))
    elif status == "not convex":
        answer = QPNotConvex(program, top.words("direction"))
    else:
        sizes = {"x": len(program.q)} | program.sizes
        answer = ExactQP(
            problem=program,
            **{name: top.array(name, (size,)) for name, size in sizes.items()},
            obj=top.number("obj"),
            obj_error=top.number("obj_error", least=0.0),
            active=tuple(top.words("active")),
            multipliers_unique=top.boolean("multipliers_unique"),
            least_norm=tuple(top.words("least_norm")),
            direction=tuple(top.words("direction")),
        )
    top.close()
    return answer


def _limits(field: str, value: Any) -> Any:
    """A field of JSON, whose nulls are infinite."""
    if field in NO_LIMIT and isinstance(value, list):
        return [NO_LIMIT[field] if v is None else v for v in value]
    return value


def _json(path: Path) -> dict[str, Mapping[str, Any]]:
    return {path.stem: vars(load_answer(path).problem)}


def _npz(path: Path) -> dict[str, Mapping[str, Any]]:
    arrays = npz_arrays(path, "a problem of qpsolvers", missing=_nothing())
    if not {"P", "q"} <= arrays.keys():
        raise InputError("is not a problem of qpsolvers: it has no P and q")
    return {path.stem: arrays}


def _mat(path: Path) -> dict[str, Mapping[str, Any]]:
    """Minimise 1/2 x'Px + q'x subject to l <= A x <= u, the last n rows of A being those of x."""
    io_ = _package("scipy.io", "scipy", "a .mat file")
    try:
        table = io_.loadmat(path)
        P, A = (getattr(table[k], "toarray", lambda k=k: table[k])() for k in ("P", "A"))
        q, low, high = (table[k].ravel().astype(np.float64) for k in ("q", "l", "u"))
    except Exception:  # SciPy raises anything at a file that is something else
        raise InputError("is not a problem of the Maros-Meszaros set, or is spoilt") from None
    low = np.where(low < -BOUNDLESS, -np.inf, low)
    high = np.where(high > BOUNDLESS, np.inf, high)
    n = len(q)
    if A.shape[0] < n or not np.array_equal(A[-n:], np.eye(n)):
        raise InputError("does not end in the bounds of its variables", field="A")
    rows, lb, ub = A[:-n], low[-n:], high[-n:]
    low, high = low[:-n], high[:-n]
    equal = low == high
    G = np.concatenate([rows[~equal], -rows[~equal]])
    h = np.concatenate([high[~equal], -low[~equal]])
    arrays = {"P": P, "q": q, "G": G[h < np.inf], "h": h[h < np.inf], "lb": lb, "ub": ub}
    return {path.stem: arrays | {"A": rows[equal], "b": low[equal]}}


def _parquet(path: Path) -> dict[str, Mapping[str, Any]]:
    parquet = _package("pyarrow.parquet", "pyarrow", "a Parquet file")
    try:
        table = parquet.read_table(path).to_pylist()
        tables = {str(row.pop("name")): row for row in table}
    except Exception:  # pyarrow raises anything at a file that is something else
        raise InputError("is not a test set of qpbenchmark, or is spoilt") from None
    for row in tables.values():
        n = len(row.get("q") or [])
        for name in ("P", "G", "A"):
            if row.get(name) is not None:
                row[name] = np.reshape(row[name], (-1, n))
    return {f"{path.stem}/{name}": row for name, row in tables.items()}


def _package(module: str, package: str, what: str) -> Any:
    try:
        return import_module(module)
    except ImportError:
        raise InputError(f"{what} is read by {package}: pip install {package}") from None
