"""Quadratic programs in the two forms that others read: qpbenchmark's Parquet, and one ``.npz``.

qpbenchmark states min 1/2 x'Px + q'x subject to G x <= h, A x = b, lb <= x <= ub, one program a
row, matrices flattened row by row. Ours has P = H, q = -g, G = -A, h = -b and no others.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.formats.files import written_whole
from quasistatic_ref.lab.vectors.files import expected_read, inputs_read
from quasistatic_ref.lab.vectors.layers.qp import matrices
from quasistatic_ref.parts import needed_package
from quasistatic_ref.step.data import Array

COLUMNS = ("P", "q", "G", "h", "A", "b", "lb", "ub", "name")


@dataclass(frozen=True, eq=False)
class Program:
    """min 1/2 x'Hx - g'x subject to Ax >= b.

    Parameters
    ----------
    name : str
    H : ndarray, shape (n, n)
    g : ndarray, shape (n,)
    A : ndarray, shape (m, n)
    b : ndarray, shape (m,)
    delta_q : ndarray, shape (n,), optional
        The exact optimum, where it is known; None if there is none. Parquet has no place for it.
    """

    name: str
    H: Array
    g: Array
    A: Array
    b: Array
    delta_q: Array | None = None


def exported_programs(folder: str | Path) -> list[Program]:
    """The polyhedral programs of a folder of vectors that have a solution, with their optima."""
    expected = expected_read(folder, "qp")
    programs = []
    for case in inputs_read(folder, "qp"):
        given = case.input
        output = expected[case.id]["output"]
        if "second_order" in given or "farkas" in output:
            continue
        programs.append(Program(case.id, *matrices(given), np.array(output["delta_q"])))
    return programs


def parquet_written(path: str | Path, programs: Sequence[Program]) -> Path:
    """Write programs so that ``qpbenchmark.ParquetTestSet`` reads them.

    Raises
    ------
    InputError
        If pyarrow is not installed, or the file cannot be written.
    """
    arrow = needed_package("pyarrow", "parquet", "a Parquet file")
    parquet = import_module("pyarrow.parquet")
    columns: dict[str, list[Any]] = {name: [None] * len(programs) for name in COLUMNS}
    columns["name"] = [program.name for program in programs]
    columns["P"] = [program.H.ravel() for program in programs]
    columns["q"] = [0.0 - program.g for program in programs]
    columns["G"] = [0.0 - program.A.ravel() if program.b.size else None for program in programs]
    columns["h"] = [0.0 - program.b if program.b.size else None for program in programs]
    kinds = {name: arrow.list_(arrow.float64()) for name in COLUMNS} | {"name": arrow.string()}
    table = arrow.table(columns, schema=arrow.schema(list(kinds.items())))
    return written_whole(path, lambda file: parquet.write_table(table, file))


def npz_written(path: str | Path, programs: Sequence[Program]) -> Path:
    """Write programs to one bundle without pickles: ``name``, and ``0/H``, ``0/g``, ``0/A``, ...

    ``K/delta_q`` is the exact optimum of program K, missing where it has none.
    """
    arrays: dict[str, Any] = {"name": np.array([program.name for program in programs], dtype=str)}
    for k, program in enumerate(programs):
        arrays |= {f"{k}/{key}": getattr(program, key) for key in ("H", "g", "A", "b")}
        if program.delta_q is not None:
            arrays[f"{k}/delta_q"] = program.delta_q
    return written_whole(path, lambda file: np.savez_compressed(file, **arrays))
