"""Numbers as text: what URDF files and point clouds have in common."""

import math
import re

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
