"""Solvers of a study that could not be imported: a file next to the rows."""

from collections.abc import Mapping
from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import json_read, json_text, text_written

UNREACHED = "unreached.json"


def unreached_written(folder: Path, reasons: Mapping[str, str]) -> None:
    """Write which solvers could not be imported, and why; a later run tries them again."""
    path = folder / UNREACHED
    if reasons:
        text_written(path, json_text(reasons) + "\n")
    else:
        path.unlink(missing_ok=True)


def unreached_read(folder: Path) -> dict[str, str]:
    """Solvers that could not be imported, with the reason.

    Raises
    ------
    InputError
        If the file holds anything else.
    """
    path = folder / UNREACHED
    reasons = json_read(path) if path.exists() else {}
    if not isinstance(reasons, dict) or not all(isinstance(v, str) for v in reasons.values()):
        raise InputError("must be a table of reasons by solver", file=path)
    return reasons
