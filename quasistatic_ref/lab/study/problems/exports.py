"""A set in two formats that others read: npz, and qpbenchmark's Parquet.

Each export carries a README with the layout of its files, the licences, and how to cite.
"""

from collections.abc import Sequence
from fractions import Fraction
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref import __version__
from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import bytes_written, text_written, written_whole
from quasistatic_ref.lab.folders import CONTACT_QP, problem_set_folder
from quasistatic_ref.lab.study.problems.names import PARQUET
from quasistatic_ref.lab.study.problems.problem import QP, Problem
from quasistatic_ref.parts import needed_package

CARRIED = ("LICENSE*", "CITATION.cff")
"""Files of contact-qp that come with every export."""
WORDS = ("id", "family", "kind", "status", "dial", "tags")
ANSWERS = ("x", "net", "slack", "lam")
QPBENCHMARK = ("P", "q", "G", "h", "A", "b", "lb", "ub", "name")
"""Columns of its Parquet files: min 1/2 x'Px + q'x subject to G x <= h, A x = b, lb <= x <= ub."""


def exported_files(name: str, problems: Sequence[Problem], to: str, folder: Path) -> list[Path]:
    """Write problems in a format.

    Parameters
    ----------
    name : str
        Of the files.
    problems : sequence of Problem
        In the units that they are to have.
    to : str
        ``npz`` or ``parquet``.
    folder : Path

    Returns
    -------
    list of Path

    Raises
    ------
    InputError
        If nothing is left to write, a package is missing, or the folder cannot be written.
    """
    problems = [one for one in problems if has_place(one, to)]
    if not problems:
        raise InputError("holds no problem that this format has a place for", value=to)
    if to == PARQUET:
        paths = _parquet(name, problems, folder)
    else:
        paths = [_npz(folder / f"{name}.npz", problems)]
    return [*paths, *_carried_files(name, len(problems), to, folder)]


def has_place(one: Problem, to: str) -> bool:
    """Whether a format has a place for a problem: qpbenchmark's for rows with a solution."""
    return to != PARQUET or (one.facts["kind"] == QP and one.feasible)


def _carried_files(name: str, count: int, to: str, folder: Path) -> list[Path]:
    """The README, the licences and the citation."""
    here = Path(__file__).parent
    layouts = (here / "layouts.txt").read_text("utf-8")
    layout = layouts.partition(f"# {to}\n")[2].partition("\n# ")[0]
    words = layout.format(name=name, stem=name.replace("-", "_")).strip()
    text = (
        (here / "export.txt")
        .read_text("utf-8")
        .format(name=name, to=to, count=count, version=__version__, layout=words)
    )
    source = problem_set_folder(CONTACT_QP)
    carried = [path for part in CARRIED for path in sorted(source.glob(part))]
    return [
        text_written(folder / "README.md", text),
        *(bytes_written(folder / path.name, path.read_bytes()) for path in carried),
    ]


def _npz(path: Path, problems: Sequence[Problem]) -> Path:
    """``id``, ``family``, ..., and ``K/H``, ``K/g``, ... of problem K."""
    arrays: dict[str, Any] = {
        word: np.array([_word(one.facts[word]) for one in problems]) for word in WORDS
    }
    for k, one in enumerate(problems):
        arrays |= {f"{k}/{key}": value for key, value in _parts(one).items()}
    return written_whole(path, lambda file: np.savez_compressed(file, **arrays))


def _parquet(name: str, problems: Sequence[Problem], folder: Path) -> list[Path]:
    """What qpbenchmark's command takes, and what answers are graded by."""
    stem = name.replace("-", "_")
    title = "".join(part.title() for part in stem.split("_"))
    template = (Path(__file__).parent / "qpbenchmark_script.txt").read_text("utf-8")
    module = template.format(name=stem, title=title, words=name)
    return [
        parquet_written(folder / f"{stem}.parquet", problems),
        _npz(folder / f"{stem}.npz", problems),
        text_written(folder / f"{stem}.py", module),
    ]


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


def _parts(one: Problem) -> dict[str, Any]:
    """Its numbers by name."""
    arrays: dict[str, Any] = {
        **one.form._asdict(),
        "length": one.error_length,
    }
    if not one.answer.farkas:
        return arrays | {key: getattr(one.answer, key) for key in ANSWERS}
    y = np.zeros(len(one.b))
    for i, text in one.answer.farkas.items():
        y[i] = Fraction(text)
    return arrays | {"farkas": y}


def _word(value: Any) -> Any:
    if isinstance(value, list):
        return ", ".join(value)
    return float("nan") if value is None else value
