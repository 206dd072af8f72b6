"""The store of a study: one SQLite file in its folder, or the same tables packed, to be kept.

Rows are added in transactions: whatever ends the program, those that were added are there, whole.
What is read is first copied into a store in memory, whose schema refuses what no study has written.
"""

import fcntl
import itertools
import json
import lzma
import os
import sqlite3
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import bytes_read, json_text
from quasistatic_ref.lab.study.store.continued import continued, solver_label
from quasistatic_ref.lab.study.store.rows import Row, flat, key_of, label_of, nested

STORE = "study.sqlite"
PACKED = "study.json.xz"
FORMAT, VERSION = "quasistatic-ref/study-store", 5
"""Versions 1 and 2 were lines of JSON; versions 3 and 4 judged claims by digits."""
SCHEMA = (Path(__file__).parent / "schema.sql").read_text("utf-8")
TABLES = ("study", "machines", "settings", "solvers", "options", "problems", "unreached", "rows")
ABOUT = ("study", "machines", "settings", "solvers", "options", "problems")
"""Tables that say what is studied."""
APART = ("kind", "time_limit", "settings", "solvers", "machine", "versions", "machines")
"""What has a table or a column of its own; the rest of a study is JSON."""
Line = tuple[Any, ...]
LARGEST_UNPACKED = 64 * 2**20
"""Largest size of all tables, of a number 8 [bytes]: those of the study 'default' have 16 MB."""
COMPUTED = "SELECT name FROM sqlite_schema WHERE type IN ('view', 'trigger')"
MOST_WORK = 100
"""Millions of SQLite's instructions that reading may take: a view need not end."""
MEMORY = 128 * 2**20
"""What the unpacking itself may take [bytes]: 65 MiB at the strongest setting."""
UNREADABLE = (sqlite3.Error, ValueError, TypeError, KeyError, AttributeError, IndexError,
                     OverflowError, RecursionError)  # fmt: skip
"""What reading raises of files that no study has written."""


@dataclass(frozen=True, eq=False)
class Contents:
    """What a store holds.

    Parameters
    ----------
    study : dict
        ``kind``, the limits, ``settings``, ``solvers``, ``machine`` and ``versions``;
        of a merged store, in which these two are by the names in ``machines``.
    rows : list of dict
        Sorted by their keys.
    problems : list of dict
        Facts of each.
    unreached : dict of str to str
        Solvers that could not be imported, with the reason.
    """

    study: dict[str, Any]
    rows: list[Row]
    problems: list[Row]
    unreached: dict[str, str]


class Store:
    """A store opened for writing, by one program at a time.

    Parameters
    ----------
    folder : Path
    study : mapping
        What it is a store of, as :class:`Contents` says. A folder that holds another is refused.
    problems : sequence of mapping
        Facts of each.

    Raises
    ------
    InputError
        If the folder holds another study, is in use, or cannot be read.
    """

    def __init__(
        self,
        folder: str | Path,
        study: Mapping[str, Any],
        problems: Sequence[Mapping[str, Any]] = (),
    ) -> None:
        self.path, wanted = Path(folder) / STORE, json.loads(json_text(study))
        self._folder = os.open(folder, os.O_RDONLY)
        try:
            fcntl.flock(self._folder, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            os.close(self._folder)
            raise InputError(
                "is being written by another run; wait for its end", file=folder
            ) from (None)
        try:
            there = contents(folder, every=True) if self.path.exists() else None
            claimed = wanted if there is None else continued(there.study, wanted, Path(folder))
            self.rows = [] if there is None else there.rows
            if there is None:
                self._make(claimed, problems)
            with self._errors_of_writing():
                self._tables = sqlite3.connect(self.path)
                self._tables.execute("PRAGMA foreign_keys = ON")
            with self._errors_of_writing(), self._tables:
                about_written(self._tables, claimed, problems)
        except BaseException:
            os.close(self._folder)
            raise

    def _make(self, study: Mapping[str, Any], problems: Sequence[Mapping[str, Any]]) -> None:
        """Make the file under another name, until it is whole: a process may end in between."""
        new = self.path.with_name(f".{STORE}")
        for path in (new, new.with_name(f"{new.name}-journal")):
            path.unlink(missing_ok=True)
        with self._errors_of_writing(), closing(sqlite3.connect(new)) as tables:
            tables.executescript(SCHEMA)
            with tables:
                about_written(tables, study, problems)
        os.replace(new, self.path)

    @property
    def keys(self) -> set[tuple[Any, ...]]:
        """Keys of the measurements that are there."""
        return set(map(key_of, self.rows))

    def add(self, *rows: Row) -> None:
        """Add measurements; all of them are in the file when this returns, or none.

        Raises
        ------
        InputError
            If they cannot be written, as on a full disk; the rows before them are kept.
        """
        with self._errors_of_writing(), self._tables:
            for row in rows:
                put(self._tables, "rows", {"machine": "", **row})
        self.rows += rows

    def keep_unreached(self, reasons: Mapping[str, str]) -> None:
        """Keep which solvers could not be imported, and why; a later run tries them again."""
        with self._errors_of_writing(), self._tables:
            self._tables.execute("DELETE FROM unreached")
            for solver, reason in reasons.items():
                put(self._tables, "unreached", {"solver": solver, "reason": reason})

    @contextmanager
    def _errors_of_writing(self) -> Iterator[None]:
        try:
            yield
        except sqlite3.Error as error:
            remedy = "its rows are kept; make room, and run the study again to go on"
            raise InputError(f"cannot be written: {error}; {remedy}", file=self.path) from None

    def close(self) -> None:
        """Close the file, and let others write."""
        self._tables.close()
        os.close(self._folder)

    def __enter__(self) -> "Store":
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()


def contents(folder: str | Path, every: bool = False) -> Contents:
    """What a store holds, packed or not.

    Parameters
    ----------
    folder : str or Path
    every : bool
        Whether solvers that are no longer in the study file are among its solvers, and their rows
        among the rows.

    Raises
    ------
    InputError
        If there is no store, or one that no study has written.
    """
    folder = Path(folder)
    path = next((folder / name for name in (STORE, PACKED) if (folder / name).exists()), None)
    if path is None:
        raise InputError("holds no store of a study", file=folder)
    with closing(sqlite3.connect(":memory:")) as tables:
        tables.executescript(SCHEMA)
        try:
            with tables:
                for name, columns, lines in (
                    _unpacked_tables if path.name == PACKED else _stored_tables
                )(path):
                    if name == "study":
                        lines = list(lines)
                        if any("sweep" in line for line in lines):  # its kind
                            problem = "is a sweep of an earlier version; run it again, in another"
                            raise InputError(f"{problem} folder", file=path)
                    insert_lines(tables, name, columns, lines)
            return _contents(tables, every)
        except UNREADABLE as error:
            if isinstance(error, InputError):
                raise
            words = " ".join(f"holds what no study has written: {error}".split())[:200]
            raise InputError(words, file=path) from None


def packed_tables(tables: Mapping[str, Mapping[str, list[Any]]]) -> bytes:
    """A packed store of some tables, column by column."""
    head = {"format": FORMAT, "version": VERSION, "tables": tables}
    text = json.dumps(head, separators=(",", ":"), allow_nan=False)
    return lzma.compress(text.encode(), preset=9 | lzma.PRESET_EXTREME)


def about_written(
    tables: sqlite3.Connection, study: Mapping[str, Any], problems: Sequence[Mapping[str, Any]]
) -> None:
    """Write what is studied, in place of what stands there."""
    for name in reversed(ABOUT):
        tables.execute(f"DELETE FROM {name}")
    facts = {name: value for name, value in study.items() if name not in APART}
    head = {"kind": study["kind"], "time_limit": study.get("time_limit"), "facts": facts}
    put(tables, "study", head)
    for name in study.get("machines", [""]):
        facts, versions = (study[of][name] if name else study[of] for of in ("machine", "versions"))
        put(tables, "machines", {"name": name, "facts": facts, "versions": versions})
    for solver in study.get("solvers", ()):
        names = {"interface": solver["interface"], "name": solver["name"]}
        present = solver.get("present", True)
        put(tables, "solvers", {**names, "target": solver["target"], "present": present})
        for setting, options in solver["options"].items():
            names = {"interface": solver["interface"], "solver": solver["name"]}
            own = {"options": options, "promise": solver["promise"][setting]}
            put(tables, "options", {**names, "setting": setting, **own})
    for name, records in (
        ("settings", study.get("settings", ())),
        ("problems", problems),
    ):
        for record in records:
            put(tables, name, record)


def put(tables: sqlite3.Connection, name: str, record: Mapping[str, Any]) -> None:
    """Add a record to a table."""
    columns = flat(record)
    insert_lines(tables, name, list(columns), [tuple(columns.values())])


def insert_lines(
    tables: sqlite3.Connection, name: str, columns: Sequence[str], lines: Iterable[Line]
) -> None:
    """Add lines to a table.

    Raises
    ------
    ValueError
        If a column has no name.
    """
    if not all(column.isidentifier() for column in columns):
        raise ValueError("a column without a name")
    if columns:
        marks = ", ".join("?" * len(columns))
        tables.executemany(f"INSERT INTO {name} ({', '.join(columns)}) VALUES ({marks})", lines)


def lines_of(tables: sqlite3.Connection, name: str) -> tuple[list[str], Iterable[Line]]:
    """Columns and lines of a table."""
    found = tables.execute(f"SELECT * FROM {name}")
    return [column[0] for column in found.description], found


def records_of(tables: sqlite3.Connection, name: str) -> Iterator[Row]:
    """The records of a table."""
    columns, lines = lines_of(tables, name)
    for line in lines:
        yield nested(dict(zip(columns, line, strict=True)))


def _stored_tables(path: Path) -> Iterator[tuple[str, list[str], Iterable[Line]]]:
    """Every table of a file of SQLite, with its columns and lines."""
    with closing(sqlite3.connect(path)) as there:
        work = itertools.count()
        there.set_progress_handler(lambda: next(work) >= MOST_WORK, 10**6)
        there.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST_UNPACKED)
        if there.execute(COMPUTED).fetchone():
            raise ValueError("a view, or a trigger")
        for name in TABLES:
            columns, lines = lines_of(there, name)
            yield name, columns, _of_some_size(lines, path)


def _of_some_size(lines: Iterable[Line], path: Path) -> Iterator[Line]:
    """The lines of a table; InputError if it is larger than any study's."""
    size = 0
    for line in lines:
        size += sum(len(one) if isinstance(one, str | bytes) else 8 for one in line)
        if size > LARGEST_UNPACKED:
            raise _too_large(path)
        yield line


def _too_large(path: Path) -> InputError:
    return InputError(f"holds more than {LARGEST_UNPACKED / 2**20:g} MiB", file=path)


def _unpacked_tables(path: Path) -> Iterator[tuple[str, list[str], Iterable[Line]]]:
    """Every packed table, with its columns and lines."""
    head = json.loads(_decompressed(path))
    if (head["format"], head["version"]) != (FORMAT, VERSION):
        raise ValueError("another format or version")
    for name in TABLES:
        columns = head["tables"][name]
        yield name, list(columns), zip(*columns.values(), strict=True)


def _decompressed(path: Path) -> bytes:
    """The content of an xz file, unless it is larger than any study's."""
    stream = lzma.LZMADecompressor(lzma.FORMAT_XZ, memlimit=MEMORY)
    try:
        content = stream.decompress(bytes_read(path), LARGEST_UNPACKED + 1)
    except lzma.LZMAError:
        content = b""
    if len(content) > LARGEST_UNPACKED:
        raise _too_large(path)
    if not stream.eof:
        raise InputError("is no xz file, or was cut off; copy it again", file=path)
    return content


def _contents(tables: sqlite3.Connection, every: bool) -> Contents:
    found = {name: list(records_of(tables, name)) for name in TABLES}
    (head,) = found["study"]
    solvers = [_solver(one, found["options"]) for one in found["solvers"]]
    study = {
        **head["facts"],
        "kind": head["kind"],
        "time_limit": head["time_limit"],
        "settings": found["settings"],
        "solvers": [one for one in solvers if every or one["present"]],
        **_machines(found["machines"]),
    }
    labels = set(map(solver_label, study["solvers"]))
    rows = [row for row in found["rows"] if label_of(row) in labels]
    if "machines" not in study:
        for row in rows:
            del row["machine"]
    unreached = {one["solver"]: one["reason"] for one in found["unreached"]}
    return Contents(study, sorted(rows, key=key_of), found["problems"], unreached)


def _solver(record: Row, options: Iterable[Row]) -> Row:
    """A solver with its options, and what it promises, by setting."""
    key = record["interface"], record["name"]
    own = [one for one in options if (one["interface"], one["solver"]) == key]
    parts = {name: {one["setting"]: one[name] for one in own} for name in ("options", "promise")}
    return record | parts


def _machines(records: list[Row]) -> Row:
    """Machine and versions; of merged stores by the names of the machines."""
    if [one["name"] for one in records] == [""]:
        return {"machine": records[0]["facts"], "versions": records[0]["versions"]}
    return {
        "machines": [one["name"] for one in records],
        "machine": {one["name"]: one["facts"] for one in records},
        "versions": {one["name"]: one["versions"] for one in records},
    }
