"""Records of long runs, kept so that a run can go on."""

import json
from collections.abc import Callable, Hashable, Iterable, Mapping
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import bytes_read, json_text, text_of, text_written

Record = dict[str, Any]


class Log:
    """Records of a long run, one JSON object a line; a last line that was cut off is dropped.

    Parameters
    ----------
    path : Path or None
        None: nothing is kept.
    key : callable
        Record -> what it is known by.
    head : mapping, optional
        The first line: the settings with which the records are made.

    Raises
    ------
    InputError
        If the file is none of such records, or they were made with other settings.
    """

    def __init__(
        self,
        path: Path | None,
        key: Callable[[Record], Hashable],
        head: Mapping[str, Any] | None = None,
    ) -> None:
        self._path = path
        self._key = key
        first = [] if head is None else [json.loads(json_text(head))]
        there = records_read(path) if path is not None and path.exists() else list(first)
        if there[: len(first)] != first:
            problem = "holds records that were made with other settings; choose another folder "
            raise InputError(f"{problem}with --out, or remove it", file=path)
        try:
            self.by_key = {key(one): one for one in there[len(first) :]}
        except (KeyError, TypeError):
            raise InputError(STRANGE, file=path) from None
        if path is not None:
            text_written(path, lines([*first, *self.by_key.values()]))

    def add(self, *records: Record) -> None:
        """Keep records; they are in the file when this returns."""
        self.by_key |= {self._key(one): one for one in records}
        if self._path is not None:
            with self._path.open("a", encoding="utf-8") as file:
                file.write(lines(records))


STRANGE = "holds something else than such records; remove it, or choose another with --out"


def lines(records: Iterable[Record]) -> str:
    """Records as text, one JSON object a line."""
    return "".join(json_text(one) + "\n" for one in records)


def records_read(path: Path) -> list[Record]:
    """The records of a file; a last line that was cut off is left out.

    Raises
    ------
    InputError
        If a line is no JSON.
    """
    text = text_of(bytes_read(path), path)
    try:
        return [json.loads(line) for line in text.split("\n")[:-1]]
    except (ValueError, RecursionError):
        raise InputError(STRANGE, file=path) from None
