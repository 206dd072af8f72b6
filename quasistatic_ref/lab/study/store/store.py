"""The store of a study: a folder whose rows are only ever added to.

``rows.jsonl`` holds one measurement a line. A line is written by one call; whatever ends the
program in the middle of it leaves a last line that does not parse, which is dropped when the study
goes on. Order in the file is the order of time; readers sort.
"""

import fcntl
import json
import lzma
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.fields import Fields
from quasistatic_ref.formats.files import bytes_read, json_read, json_text, text_of, text_written
from quasistatic_ref.lab.study.store.claim import continued
from quasistatic_ref.lab.study.store.old_rows import today_row, today_study
from quasistatic_ref.lab.study.store.schema import (
    MERGED_ROW,
    SOLVER_ROW,
    STUDIES,
    SWEEP_ROW,
    Shape,
    check_machines,
    checked,
)

ROWS, STUDY = "rows.jsonl", "study.json"
VERSION = 2
"""Of a store of solvers; rows of version 1 are read by :mod:`.old_rows`."""
PACKED = "rows.jsonl.xz"
"""The rows of a store that was packed to be kept, not to be continued."""
LARGEST_UNPACKED = 256 * 2**20
"""Largest size of packed rows [bytes]: those of the study 'default' have 26 MiB."""
MEMORY = 128 * 2**20
"""What the unpacking itself may take [bytes]: 65 MiB at the strongest setting."""
KEY = ("problem", "solver", "interface", "setting", "warm", "units", "repetition")
"""What makes a measurement the same one."""
SWEEP_KEY = ("sweep", "values")
MACHINE_DEPENDENT = ("seconds", "calls", "clock_agrees", "memory")
"""Fields that differ from run to run."""

Row = dict[str, Any]


def key_of(row: Row) -> str:
    """The key of a row as text: equal for equal measurements, and sortable."""
    names = KEY if "problem" in row else SWEEP_KEY
    machine = [row["machine"]] if "machine" in row else []
    return json.dumps([*(row[name] for name in names), *machine], sort_keys=True)


def label_of(row: Row) -> str:
    """A row's solver with its interface, ``interface:solver``."""
    return f"{row['interface']}:{row['solver']}"


class Store:
    """A store opened for writing, by one program at a time.

    Parameters
    ----------
    folder : str or Path
        Made if it is missing.
    study : mapping
        What ``study.json`` holds. A folder that holds another study is refused.

    Raises
    ------
    InputError
        If the folder holds another study, is in use, or cannot be read.
    """

    def __init__(self, folder: str | Path, study: dict[str, Any]) -> None:
        self.folder = Path(folder)
        claimed = self._claimed(study)
        path = self.folder / ROWS
        try:
            self._file = path.open("ab", buffering=0)
        except OSError as error:
            raise self._unwritable(error) from None
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            self._file.close()
            raise InputError("is being written by another run; wait for its end", file=path) from (
                None
            )
        try:
            text_written(self.folder / STUDY, json_text(claimed) + "\n")
            self.rows, whole = _parsed(path)
            self._file.truncate(whole)
        except OSError as error:
            self.close()
            raise self._unwritable(error) from None
        except InputError:
            self.close()
            raise

    def _claimed(self, study: dict[str, Any]) -> dict[str, Any]:
        """What ``study.json`` is to hold, where the folder has none or one that can go on."""
        if not (self.folder / STUDY).exists():
            return study
        there = study_read(self.folder)
        if "machines" in there:
            problem = "holds merged results, which no machine continues; choose another with --out"
            raise InputError(problem, file=self.folder)
        if there.get("version") != study["version"]:
            problem = (
                f"holds a store of version {there.get('version')}, which is read and reported "
                "but not continued; choose another folder with --out"
            )
            raise InputError(problem, file=self.folder)
        try:
            return continued(there, json.loads(json_text(study)))
        except InputError as error:
            raise error.in_file(self.folder) from None

    @property
    def keys(self) -> set[str]:
        """Keys of the measurements that are there."""
        return {key_of(row) for row in self.rows}

    def add(self, row: Row) -> None:
        """Add one measurement; it is in the file when this returns.

        Raises
        ------
        InputError
            If it cannot be written, as on a full disk; the rows before it are kept.
        """
        left = (json_text(row) + "\n").encode()
        try:
            while left:
                left = left[self._file.write(left) :]
        except OSError as error:
            raise self._unwritable(error) from None
        self.rows.append(row)

    def _unwritable(self, error: OSError) -> InputError:
        remedy = "its whole rows are kept; make room, and run the study again to go on"
        reason = f"cannot be written: {error.strerror or error}; {remedy}"
        return InputError(reason, file=self.folder / ROWS)

    def close(self) -> None:
        """Close the file, and let others write."""
        self._file.close()

    def __enter__(self) -> "Store":
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()


def rows_read(folder: str | Path) -> list[Row]:
    """The rows of a store, packed or not, sorted by their keys; a torn last line is left out.

    Raises
    ------
    InputError
        If there is no store, or a line before the last does not parse.
    """
    path = Path(folder) / ROWS
    if not path.exists() and path.with_name(PACKED).exists():
        path = path.with_name(PACKED)
    rows, _ = _parsed(path)
    return sorted(rows, key=key_of)


def study_read(folder: str | Path) -> dict[str, Any]:
    """What ``study.json`` of a store holds.

    Raises
    ------
    InputError
        If there is no store.
    """
    study = json_read(Path(folder) / STUDY)
    if not isinstance(study, dict) or study.get("format") != "quasistatic-ref/study-store":
        raise InputError("is no store of a study", file=folder)
    try:
        json_text(study)
    except ValueError:  # NaN and 1e999, which Python reads and JSON does not have
        raise InputError("holds a number that is not finite", file=Path(folder) / STUDY) from None
    return today_study(study)


def study_checked(folder: str | Path) -> dict[str, Any]:
    """The same, with every field that a report needs.

    Raises
    ------
    InputError
        Naming the field that is missing, or not as it must be.
    """
    study, path = study_read(folder), Path(folder) / STUDY
    try:
        kind = Fields(study).text("kind", choices=tuple(STUDIES))
        checked(study, STUDIES[kind])
        if "machines" in study:
            check_machines(study)
    except InputError as error:
        raise error.in_file(path) from None
    return study


def lines_read(path: Path, shape: Shape) -> list[Row]:
    """JSON objects of one shape, one a line.

    Raises
    ------
    InputError
        Naming the line and the field.
    """
    rows: list[Row] = []
    for number, line in enumerate(bytes_read(path).split(b"\n"), start=1):
        if line.strip():
            try:
                row = json.loads(text_of(line, path))
            except (ValueError, InputError, RecursionError):
                raise InputError("is no JSON", file=path, field=f"line {number}") from None
            rows.append(_checked(row, shape, path, number))
    return rows


def _checked(row: Row, shape: Shape, path: Path, number: int) -> Row:
    try:
        checked(row, shape, strict=True)
    except InputError as error:
        named = f"line {number}{f', {error.field}' if error.field else ''}"
        raise InputError(error.problem, file=path, field=named, value=error.value) from None
    return row


def table(rows: Iterable[Row]) -> list[Row]:
    """Rows without what differs from run to run, sorted: equal for equal studies."""
    kept = [{k: v for k, v in row.items() if k not in MACHINE_DEPENDENT} for row in rows]
    return sorted(kept, key=key_of)


def _parsed(path: Path) -> tuple[list[Row], int]:
    """Return the rows of a file, and the length of what parses [bytes]."""
    content = _unpacked(path) if path.name == PACKED else bytes_read(path)
    rows: list[Row] = []
    keys: set[str] = set()
    whole = 0
    lines = content.split(b"\n")
    for number, line in enumerate(lines[:-1], start=1):
        try:
            row = today_row(json.loads(text_of(line, path)))
            key = key_of(row)
        except (ValueError, InputError, KeyError, TypeError, RecursionError):
            if number == len(lines) - 1:
                break  # the last line, torn
            raise InputError(
                "is no row of a study; remove this line, or the folder",
                file=path,
                field=f"line {number}",
            ) from None
        rows.append(_checked(row, _shape(row), path, number))
        if key in keys:
            problem = "is a measurement that stands before it already; remove one of the two"
            raise InputError(problem, file=path, field=f"line {number}")
        keys.add(key)
        whole += len(line) + 1
    return rows, whole


def _shape(row: Row) -> Shape:
    if "problem" not in row:
        return SWEEP_ROW
    return MERGED_ROW if "machine" in row else SOLVER_ROW


def _unpacked(path: Path) -> bytes:
    """The content of an xz file, unless it is larger than any study's rows."""
    stream = lzma.LZMADecompressor(lzma.FORMAT_XZ, memlimit=MEMORY)
    try:
        content = stream.decompress(bytes_read(path), LARGEST_UNPACKED + 1)
    except lzma.LZMAError:
        raise InputError("is no xz file, or was cut off; copy it again", file=path) from None
    if len(content) > LARGEST_UNPACKED:
        most = LARGEST_UNPACKED / 2**20
        raise InputError(f"unpacks to more than {most:g} MiB", file=path)
    if not stream.eof:
        raise InputError("is no xz file, or was cut off; copy it again", file=path)
    return content
