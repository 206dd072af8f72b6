"""Files and numbers as text: what URDF files and point clouds have in common."""

from __future__ import annotations

import math
import re
from pathlib import Path

from quasistatic_ref.errors import ModelError

_DECIMAL = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


def file_bytes(path: str | Path) -> bytes:
    """Content of a file.

    Raises
    ------
    ModelError
        If it does not exist or cannot be read.
    """
    try:
        return Path(path).read_bytes()
    except FileNotFoundError:
        raise ModelError("no such file", file=path) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise ModelError(f"cannot be read: {reason}", file=path) from None


def utf8_text(content: bytes, path: str | Path) -> str:
    """Content as text; a byte-order mark is dropped.

    Raises
    ------
    ModelError
        If it is not UTF-8.
    """
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        raise ModelError("is not UTF-8 text", file=path, field=f"line {line}") from None


def decimal(text: str) -> float:
    """Finite number written in decimal, e.g. ``-1.5e-3``.

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
