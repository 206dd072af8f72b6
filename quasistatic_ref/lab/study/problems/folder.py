"""The folder of a set: lines of facts, numbers family by family, and a manifest of hashes.

``problems.jsonl`` has a line for each problem, in order, and ``numbers/FAMILY.npz`` the numbers of
a family, one problem after the other. Any NumPy opens it; see its README.
"""

import hashlib
import json
import lzma
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from quasistatic_ref.errors import InputError
from quasistatic_ref.files.npz import npz_arrays
from quasistatic_ref.lab.study.problems.problem import ENCLOSED, EXACT, Answer, Problem
from quasistatic_ref.step.standard_form import Units
from quasistatic_ref.text.content import LARGEST_TEXT, bytes_read, json_read
from quasistatic_ref.text.table_reader import TableReader

FORMAT = "quasistatic-ref/problem-set"
VERSION = 1
MANIFEST = "manifest.json"
FACTS = "problems.jsonl"
NUMBERS = "numbers"
PROVED = (EXACT, ENCLOSED)
UNREADABLE = (KeyError, TypeError, ValueError, IndexError, AttributeError, OverflowError,
                     RecursionError, lzma.LZMAError)  # fmt: skip
"""What reading raises of files that agree with their manifest, and are something else."""


def set_read(folder: Path, families: Sequence[str] | None = None) -> list[Problem]:
    """The problems of a set, or of some of its families.

    Families with answers that are not proved are left out.

    Raises
    ------
    InputError
        If it is no set, a file is not the one that its manifest lists, or a family is unknown.
    """
    known = list(manifest(folder)["families"])
    try:
        return _problems_of(folder, known, families)
    except InputError:
        raise
    except UNREADABLE as error:
        words = f"holds files that are no set of problems: {type(error).__name__}: {error}"
        raise InputError(words[:200], file=folder) from None


def _problems_of(
    folder: Path, known: Sequence[str], families: Sequence[str] | None
) -> list[Problem]:
    lines = _lines(folder / FACTS)
    unproved = {line["family"] for line in lines if line["answer"]["kind"] not in PROVED}
    proved = [family for family in known if family not in unproved]
    for name in families or ():
        if name not in proved:
            words = f"is not a family with proved answers; the set has {', '.join(proved)}"
            raise InputError(words, value=name)
    return [
        one
        for family in proved
        if families is None or family in families
        for one in _problems(folder, family, [x for x in lines if x["family"] == family])
    ]


def manifest(folder: Path) -> dict[str, Any]:
    """The manifest of a set, every file of it checked against its hash.

    Raises
    ------
    InputError
        If it is missing or no manifest, or a file was changed.
    """
    path = folder / MANIFEST
    if not path.exists():
        raise InputError("holds no set of problems; name one with a manifest", file=folder)
    try:
        top = TableReader(head := json_read(path))
        top.check_format(FORMAT, VERSION)
        top.table("families")
        for one in top.tables("files"):
            name = one.text("path")
            wanted = one.text("sha256")
            if name not in (FACTS, *(f"{NUMBERS}/{family}.npz" for family in head["families"])):
                raise one.error_about("path", "is no file of a set", name)
            if _hash(bytes_read(folder / name)) != wanted:
                raise one.error_about("sha256", "is not that of the file, which was changed", name)
    except InputError as error:
        raise error.in_file(path) from None
    return dict(head)


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _lines(path: Path) -> list[dict[str, Any]]:
    text = bytes_read(path, largest=LARGEST_TEXT).decode("utf-8")
    return [json.loads(line) for line in text.splitlines()]


def _problems(folder: Path, family: str, lines: Sequence[Mapping[str, Any]]) -> list[Problem]:
    path = folder / NUMBERS / f"{family}.npz"
    arrays = npz_arrays(path, "the numbers of a family")
    at = dict.fromkeys(arrays, 0)

    def numbers(name: str, size: int) -> NDArray[Any]:
        first = at[name]
        last = at[name] + size
        if last > len(arrays[name]):
            raise InputError(f"has too few numbers of {name}", file=path)
        at[name] = last
        return arrays[name][first:last]

    def matrix(name: str, rows: int, columns: int) -> csr_matrix:
        starts = np.concatenate([[0], np.cumsum(numbers(f"{name}_entries", rows), dtype=np.int64)])
        count = int(starts[-1])
        values = numbers(f"{name}_values", count)
        places = numbers(f"{name}_columns", count)
        return csr_matrix((values, places.astype(np.int32), starts), shape=(rows, columns))

    def one(line: Mapping[str, Any]) -> Problem:
        n = line["n"]
        m = line["m"]
        solved = line["farkas"] is None
        H = matrix("H", n, n)
        A = matrix("A", m, n)
        g = numbers("g", n)
        b = numbers("b", m)
        S = np.exp2(numbers("coordinate", n).astype(np.float64))
        exponents = line["log2_units"]
        units = Units(S, 2.0 ** exponents["length"], 2.0 ** exponents["size"])
        record = line["answer"]
        x, net, slack, lam = (
            numbers(name, size if solved else 0) if name in arrays else np.zeros(0)
            for name, size in (("x", n), ("net", n), ("slack", m), ("lam", m))
        )
        farkas = {int(i): y for i, y in (line["farkas"] or {}).items()}
        answer = Answer(record["kind"], record["error"], x, net, slack, lam, farkas)
        facts = {key: v for key, v in line.items() if key not in ("log2_units", "farkas")}
        return Problem(facts, H, g, A, b, units, answer)

    problems = [one(line) for line in lines]
    if any(at[name] != len(array) for name, array in arrays.items()):
        raise InputError("has more numbers than problems", file=path)
    return problems
