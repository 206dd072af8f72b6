"""A store made small enough to keep in a repository: the same rows, shorter numbers."""

import json
import lzma
import math
from pathlib import Path
from typing import Any

from quasistatic_ref.formats.files import (
    bytes_read,
    bytes_written,
    json_text,
    text_written,
    writable_folder,
)
from quasistatic_ref.lab.study.problems.study_problems import FACTS
from quasistatic_ref.lab.study.store.store import (
    PACKED,
    STUDY,
    Row,
    rows_read,
    study_checked,
)
from quasistatic_ref.lab.study.store.unreached import UNREACHED, unreached_read

FIGURES = 3
"""Significant figures of times and residuals: their noise is larger."""
DECIMALS = 3
"""Of digits, which are rounded down, so that no threshold is passed that was not."""


def packed(folder: str | Path, out: str | Path) -> list[Path]:
    """Write a store again, packed; ``study report`` reads it as it reads the other.

    Parameters
    ----------
    folder : str or Path
        A store of solvers or of sweeps.
    out : str or Path

    Returns
    -------
    list of Path
        What was written. A packed store is not continued: ``study run`` starts a new one.
    """
    folder, out = Path(folder), writable_folder(out)
    study = study_checked(folder)
    lines = "".join(json_text(shorter(row)) + "\n" for row in rows_read(folder))
    content = lzma.compress(lines.encode(), preset=9 | lzma.PRESET_EXTREME)
    written = [
        text_written(out / STUDY, json_text(study) + "\n"),
        bytes_written(out / PACKED, content),
    ]
    if reasons := unreached_read(folder):
        written.append(text_written(out / UNREACHED, json_text(reasons) + "\n"))
    if study["kind"] == "solvers":
        written.append(text_written(out / FACTS, bytes_read(folder / FACTS).decode()))
    return written


def shorter(row: Row) -> Row:
    """A row with its numbers shortened; twice shortened is once shortened."""
    if "problem" not in row:
        return row
    changed: dict[str, Any] = {
        "digits": {k: None if v is None else _down(v) for k, v in row["digits"].items()},
        "residuals": {k: _figures(v) for k, v in row["residuals"].items()},
        "seconds": {k: _figures(v) for k, v in row["seconds"].items()},
    }
    short: Row = json.loads(json.dumps(row | changed))
    return short


def _down(value: float) -> float:
    scale = 10.0**DECIMALS
    return math.floor(round(value * scale, 6)) / scale


def _figures(value: float | None) -> float | None:
    return None if value is None else float(f"{value:.{FIGURES}g}")
