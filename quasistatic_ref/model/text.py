"""Numbers as text: what URDF files and point clouds have in common."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import ModelError

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


def ascii_points(
    body: bytes, first: int, columns: Sequence[int], width: int, most: int
) -> NDArray[np.float64]:
    """Points written one a line, shape (at most `most`, 3) [m]; blank lines are passed over.

    Parameters
    ----------
    body : bytes
    first : int
        Number of its first line in the file, for messages.
    columns : sequence of int
        Which numbers of a line are x, y and z.
    width : int
        How many numbers a line has.
    most : int
        Lines after so many points are not read.

    Raises
    ------
    ModelError
        If a line has another number of words, or one of the three is no number.
    """
    points: list[list[float]] = []
    for number, line in enumerate(body.decode("ascii", errors="replace").splitlines(), start=first):
        if len(points) == most:
            break
        words = line.split()
        if not words:
            continue
        if len(words) != width:
            raise ModelError(f"must be {width} numbers", field=f"line {number}", value=line)
        try:
            points.append([decimal(words[c]) for c in columns])
        except ModelError as error:
            error.field = f"line {number}"
            raise
    return np.array(points, dtype=np.float64).reshape(-1, 3)
