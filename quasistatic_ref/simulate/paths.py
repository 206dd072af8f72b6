"""Where the files that a scenario names may be.

A path in a scenario file is relative to the file's folder and leads to a file inside it, symbolic
links followed: a scenario from somebody else reads nothing but what came with it. A path given by
``--set`` is the user's own, and may lead anywhere.
"""

from __future__ import annotations

from pathlib import Path

from quasistatic_ref.errors import ScenarioError
from quasistatic_ref.fields import Fields


class OwnWord(str):
    """A string that came from ``--set``, not from the file."""

    __slots__ = ()


def path_in(folder: Path, table: Fields, field: str) -> Path | None:
    """The path in one field, or None where there is no such field.

    Raises
    ------
    ScenarioError
        If it leads out of the folder, or cannot be a path.
    """
    text = table.text(field, None)
    if text is None:
        return None
    if not text.strip():
        raise table.fail(field, "must name a file", text)
    path = folder / text
    if isinstance(text, OwnWord):
        return path
    try:
        inside = path.resolve().is_relative_to(folder.resolve())
    except (ValueError, RuntimeError, OSError) as error:  # a NUL character; links in a circle
        raise table.fail(field, f"cannot be a path: {error}", text) from None
    if not inside:
        raise _leaves(table, field, text)
    return path


def _leaves(table: Fields, field: str, text: str) -> ScenarioError:
    name = table.name(field)
    return ScenarioError(
        "leaves the scenario's folder; put the file there, or give the path on the command line, "
        f"as --set {name}=PATH",
        field=name,
        value=text,
    )
