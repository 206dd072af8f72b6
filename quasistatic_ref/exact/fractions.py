"""Fractions as texts."""

import re
from collections.abc import Sequence

from flint import fmpq, fmpz

_FRACTION = re.compile(r"(-?[0-9]+)(?:/([0-9]*[1-9][0-9]*))?")


def fractions_read(texts: Sequence[str]) -> list[fmpq] | None:
    """The fractions ``"p/q"`` or ``"p"``; None if a text is none."""
    # By pattern first: Fraction would read "1e999999999", and never return.
    parts = [_FRACTION.fullmatch(str(text)) for text in texts]
    read = [fmpq(fmpz(part[1]), fmpz(part[2] or "1")) for part in parts if part]
    return read if len(read) == len(parts) else None
