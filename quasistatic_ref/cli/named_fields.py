"""The fields of a scenario's file by the names that ``--set`` takes."""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from quasistatic_ref.text.content import toml_read
from quasistatic_ref.text.json_text import json_text

BARE: Final = re.compile(r"[A-Za-z0-9_-]+")
"""What TOML takes as a key without quotes."""
WIDTH: Final = 60
"""Characters of a value that are printed."""


def named_fields(path: Path) -> dict[str, Any]:
    """Dotted name -> value of every field of a scenario that was loaded from this file.

    A list, of numbers or of tables, is one field: ``--set`` replaces all of it.
    """
    return dict(_flat(toml_read(path), ""))


def _flat(table: Mapping[str, Any], prefix: str) -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        name = prefix + (key if BARE.fullmatch(key) else json_text(key))
        if isinstance(value, Mapping):
            yield from _flat(value, f"{name}.")
        else:
            yield name, value


def field_lines(fields: Mapping[str, Any]) -> list[str]:
    """A line ``name = value`` for each field, with long values cut."""
    texts = {name: json_text(value) for name, value in fields.items()}
    return [
        f"{name} = {text if len(text) <= WIDTH else text[: WIDTH - 4] + ' ...'}"
        for name, text in texts.items()
    ]
