"""Numbers as text, and numbers that a file states: what robots, meshes and clouds share."""

import math
import re
from collections.abc import Sequence

from quasistatic_ref.errors import ModelError
from quasistatic_ref.text.content import LARGEST_TEXT

MOST_POINTS = 1_000_000
"""Most points of a cloud; its text has at most twice as many lines, with comments and a header."""

LONGEST_LINE = 100_000
"""Most characters of a line of a cloud or a mesh: each of its words takes some 60 bytes."""

_DECIMAL = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


def decimal(text: str) -> float:
    """Finite number written in decimal, e.g. ``-1.5e-3`` [any unit].

    Stricter than :class:`float`, which also reads ``nan``, ``1_000`` and digits of other
    scripts: a file that another reader would take differently is refused.

    Raises
    ------
    ModelError
        If the text is anything else, or too large for float64.
    """
    stripped = text.strip()
    if not _DECIMAL.fullmatch(stripped):
        raise ModelError("must be a finite decimal number", value=text)
    number = float(stripped)
    if not math.isfinite(number):
        raise ModelError("must be a finite decimal number; this one overflows", value=text)
    return number


def number_or_nan(text: str) -> float:
    """Number as :func:`decimal` reads it [any unit], or NaN where the text is ``nan``."""
    return math.nan if text.strip().lower() in ("nan", "-nan") else decimal(text)


def point_lines(text: str) -> list[str]:
    """The lines of a text of points; ModelError if they are too many, or too long in all."""
    if len(text) > LARGEST_TEXT:
        raise ModelError(f"is a text of more than {LARGEST_TEXT / 2**20:g} MiB; thin it out")
    lines = text.splitlines()
    if len(lines) > 2 * MOST_POINTS:
        problem = f"holds more than {2 * MOST_POINTS} lines; thin it out"
        raise ModelError(problem, value=len(lines))
    check_lines(lines)
    return lines


def check_lines(lines: Sequence[str]) -> None:
    """ModelError if a line is too long, before it is split into words."""
    number = next((k for k, line in enumerate(lines, 1) if len(line) > LONGEST_LINE), None)
    if number is not None:
        problem = f"is longer than {LONGEST_LINE} characters; break it"
        raise ModelError(problem, field=f"line {number}", value=lines[number - 1])


def check_points(count: int) -> None:
    """ModelError if these are more points than a cloud may have."""
    if count > MOST_POINTS:
        raise ModelError(f"holds more than {MOST_POINTS} points; thin it out", value=count)


def unseen_note(count: int) -> str:
    """What became of points that are NaN."""
    return f"{count} points that are not numbers are left out, as what was not seen"


def check_equal(what: str, count: int, stated: int) -> None:
    """ModelError if a file holds another number than it states."""
    if count != stated:
        raise ModelError(f"must be {stated}, as the file states", field=what, value=count)
