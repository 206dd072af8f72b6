"""A set in the formats that others read: npz, qpbenchmark's parquet, MATLAB's mat, JSON, QPS.

Each export carries a README with the layout of its files, the licences, and how to cite.
"""

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from scipy.io import savemat
from scipy.sparse import csc_matrix, csr_matrix, tril

from quasistatic_ref import __version__
from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import bytes_written, json_text, text_written, written_whole
from quasistatic_ref.lab.folders import CONTACT_QP_2, EDITIONS, problem_set_folder
from quasistatic_ref.lab.study.problems.names import PARQUET, QPS
from quasistatic_ref.lab.study.problems.problem import QP, Problem
from quasistatic_ref.parts import needed_package

CARRIED = ("LICENSE*", "CITATION.cff")
"""Files of a set that come with every export of it; of contact-qp-2, where a set has none."""
WORDS = ("id", "family", "kind", "status", "dial", "tags")
VECTORS = ("g", "b")
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
        One of ``npz``, ``parquet``, ``mat``, ``json``, ``qps``.
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
    own: dict[str, Callable[[], list[Path]]] = {
        "npz": lambda: [_npz(folder / f"{name}.npz", problems)],
        "mat": lambda: [_mat(folder / f"{name}.mat", problems)],
        "json": lambda: [_json(folder / f"{name}.jsonl", problems)],
        PARQUET: lambda: _parquet(name, problems, folder),
        QPS: lambda: [*(_qps(folder / "qps", one) for one in problems),
                      _npz(folder / f"{name}.npz", problems)],
    }  # fmt: skip
    return [*own[to](), *_carried_files(name, len(problems), to, folder)]


def has_place(one: Problem, to: str) -> bool:
    """Whether a format has a place for a problem: qpbenchmark's for dense rows with a solution."""
    rows = one.facts["kind"] == QP
    if to == PARQUET:
        return rows and one.feasible and not one.sparse
    return rows or to != QPS


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
    edition = next((one for one in EDITIONS if name.startswith(one)), CONTACT_QP_2)
    source = problem_set_folder(edition)
    found = [path for part in CARRIED for path in sorted(source.glob(part))]
    return [
        text_written(folder / "README.md", text),
        *(bytes_written(folder / path.name, path.read_bytes()) for path in found),
    ]


def _qps(folder: Path, one: Problem) -> Path:
    """A file of one problem: free MPS, with the lower triangle of H."""
    H = tril(one.H).tocoo()
    A = csc_matrix(one.A)
    name = one.id.replace("/", "_").replace(" ", "_")
    lines = [f"NAME {name}", "ROWS", " N objective", *(f" G r{i}" for i in range(len(one.b)))]
    lines.append("COLUMNS")
    for j, cost in enumerate((-one.g).tolist()):
        lines.append(f" x{j} objective {cost!r}")
        entries = slice(A.indptr[j], A.indptr[j + 1])
        pairs = zip(A.indices[entries].tolist(), A.data[entries].tolist(), strict=True)
        lines += [f" x{j} r{i} {value!r}" for i, value in pairs]
    lines += ["RHS", *(f" rhs r{i} {value!r}" for i, value in enumerate(one.b.tolist()))]
    lines += ["BOUNDS", *(f" FR bounds x{j}" for j in range(len(one.g)))]
    triples = zip(H.row.tolist(), H.col.tolist(), H.data.tolist(), strict=True)
    lines += ["QUADOBJ", *(f" x{i} x{j} {value!r}" for i, j, value in triples), "ENDATA"]
    return text_written(folder / f"{name}.mps", "\n".join(lines) + "\n")


def _npz(path: Path, problems: Sequence[Problem]) -> Path:
    """``id``, ``family``, ..., and ``K/H``, ``K/g``, ... of problem K; sparse matrices as CSR."""
    arrays: dict[str, Any] = {
        word: np.array([_word(one.facts[word]) for one in problems]) for word in WORDS
    }
    for k, one in enumerate(problems):
        for key, value in _parts(one).items():
            if isinstance(value, csr_matrix):
                arrays |= {f"{k}/{key}/values": value.data, f"{k}/{key}/columns": value.indices,
                           f"{k}/{key}/starts": value.indptr}  # fmt: skip
            else:
                arrays[f"{k}/{key}"] = value
    return written_whole(path, lambda file: np.savez_compressed(file, **arrays))


def _mat(path: Path, problems: Sequence[Problem]) -> Path:
    """A struct array ``problems``, as MATLAB's and Julia's readers of .mat files show it."""
    names = (*WORDS, "H", "A", *VECTORS, *ANSWERS, "farkas")
    table = np.zeros(len(problems), dtype=[(name, object) for name in names])
    empty = np.zeros((0, 1))
    for k, one in enumerate(problems):
        for word in WORDS:
            table[k][word] = _word(one.facts[word])
        parts = _parts(one)
        for key in names[len(WORDS) :]:
            value = parts.get(key, empty)
            column = isinstance(value, np.ndarray) and value.ndim == 1
            table[k][key] = csc_matrix(value) if isinstance(value, csr_matrix) else value
            if column:
                table[k][key] = value[:, None]
    found = {"problems": table}
    return written_whole(path, lambda file: savemat(file, found, do_compression=True))


def _json(path: Path, problems: Sequence[Problem]) -> Path:
    """A line for each problem: its facts and its numbers, in shortest round-trip decimal."""

    def lines() -> Iterator[str]:
        for one in problems:
            numbers = {
                key: {"rows": value.shape[0], "starts": value.indptr.tolist(),
                      "columns": value.indices.tolist(), "values": value.data.tolist()}
                if isinstance(value, csr_matrix) else value.tolist()
                for key, value in _parts(one).items() if key != "farkas"
            }  # fmt: skip
            farkas = {str(i): y for i, y in one.answer.farkas.items()}
            yield json_text(dict(one.facts) | numbers | ({"farkas": farkas} if farkas else {}))

    return text_written(path, "\n".join(lines()) + "\n")


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
    """Its numbers by name: matrices dense, unless it is a sparse problem."""
    sparse = one.sparse
    found: dict[str, Any] = {
        "H": one.H if sparse else one.H.toarray(),
        "A": one.A if sparse else one.A.toarray(),
        "g": one.g,
        "b": one.b,
    }
    if not one.answer.farkas:
        return found | {key: getattr(one.answer, key) for key in ANSWERS}
    y = np.zeros(len(one.b))
    for i, text in one.answer.farkas.items():
        y[i] = Fraction(text)
    return found | {"farkas": y}


def _word(value: Any) -> Any:
    if isinstance(value, list):
        return ", ".join(value)
    return float("nan") if value is None else value
