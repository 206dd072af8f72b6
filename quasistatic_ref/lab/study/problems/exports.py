"""A set as a test set of qpbenchmark, with a module that grades by the exact answers.

An export carries a README with the layout of its files, the licences, and how to cite.
"""

from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref import __version__
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.folders import contact_qp_folder
from quasistatic_ref.lab.study.problems.problem import QP, Problem
from quasistatic_ref.parts import needed_package
from quasistatic_ref.text.content import bytes_written, text_written, written_whole

CARRIED = ("LICENSE*", "CITATION.cff")
"""Files of contact-qp that come with every export."""
QPBENCHMARK = ("P", "q", "G", "h", "A", "b", "lb", "ub", "name")
"""Columns of its Parquet files: min 1/2 x'Px + q'x subject to G x <= h, A x = b, lb <= x <= ub."""


def exported_files(name: str, problems: Sequence[Problem], folder: Path) -> list[Path]:
    """Write what qpbenchmark's command takes, and what answers are graded by.

    Parameters
    ----------
    name : str
        Of the files.
    problems : sequence of Problem
        In the units that they are to have; those for which there is no place are left out.
    folder : Path

    Returns
    -------
    list of Path

    Raises
    ------
    InputError
        If nothing is left to write, a package is missing, or the folder cannot be written.
    """
    problems = [one for one in problems if has_place(one)]
    if not problems:
        problem = "holds no problem that the format has a place for; name one with a solution"
        raise InputError(problem, value=name)
    stem = name.replace("-", "_")
    title = "".join(part.title() for part in stem.split("_"))
    here = Path(__file__).parent
    module = (here / "qpbenchmark_script.txt").read_text("utf-8")
    readme = (here / "export.txt").read_text("utf-8")
    words = {"name": name, "stem": stem, "title": title, "count": len(problems)}
    carried = [path for part in CARRIED for path in sorted(contact_qp_folder().glob(part))]
    return [
        parquet_written(folder / f"{stem}.parquet", problems),
        _answers(folder / f"{stem}.npz", problems),
        text_written(folder / f"{stem}.py", module.format(**words)),
        text_written(folder / "README.md", readme.format(**words, version=__version__)),
        *(bytes_written(folder / path.name, path.read_bytes()) for path in carried),
    ]


def has_place(one: Problem) -> bool:
    """Whether qpbenchmark's format has a place for a problem: rows that have a solution."""
    return one.facts["kind"] == QP and one.feasible


def _answers(path: Path, problems: Sequence[Problem]) -> Path:
    """The exact x of each problem, and the length that errors are divided by."""
    arrays: dict[str, Any] = {}
    for one in problems:
        arrays |= {f"{one.id}/x": one.answer.x, f"{one.id}/length": one.error_length}
    return written_whole(path, lambda file: np.savez_compressed(file, **arrays))


def parquet_written(path: Path, problems: Sequence[Problem]) -> Path:
    """Write problems so that ``qpbenchmark.ParquetTestSet`` reads them, one a row.

    Ours have P = H, q = -g, G = -A and h = -b; matrices are flattened row by row.

    Raises
    ------
    InputError
        If pyarrow is not installed, or the file cannot be written.
    """
    arrow = needed_package("pyarrow", "parquet", "a Parquet file")
    parquet = import_module("pyarrow.parquet")
    columns: dict[str, list[Any]] = {key: [None] * len(problems) for key in QPBENCHMARK}
    columns["name"] = [one.id for one in problems]
    forms = [one.form for one in problems]
    columns["P"] = [form.H.ravel() for form in forms]
    columns["q"] = [0.0 - form.g for form in forms]
    columns["G"] = [0.0 - form.A.ravel() if form.b.size else None for form in forms]
    columns["h"] = [0.0 - form.b if form.b.size else None for form in forms]
    kinds = {key: arrow.list_(arrow.float64()) for key in QPBENCHMARK} | {"name": arrow.string()}
    table = arrow.table(columns, schema=arrow.schema(list(kinds.items())))
    return written_whole(path, lambda file: parquet.write_table(table, file))
