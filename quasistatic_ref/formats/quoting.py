"""What a sentence repeats of what was given: on one line, clipped, with the nearest known name.

And tables in lines of text.
"""

import difflib
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

LONGEST = 200
"""Most characters of anything given that a sentence repeats."""
MOST_NAMES = 50
"""Most names that a sentence lists."""
OTHER_WORDS = {
    "dt": "h",
    "time_step": "h",
    "timestep": "h",
    "time": "t",
    "friction": "mu_v",
    "torsion": "mu_omega",
    "stiffness": "K_q",
    "solver": "backend",
    "tolerance": "accuracy",
    "tol": "accuracy",
    "eps": "accuracy",
    "joints": "actuated",
}
"""What other programs call a field, and how it is called here."""


def one_line(text: str) -> str:
    """Text whose line ends and control characters are escaped: names come from any file."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)


def clipped(text: str, longest: int = LONGEST) -> str:
    """Text of at most so many characters; a longer one loses its middle."""
    if len(text) <= longest:
        return text
    head = (longest - 3) // 2
    return f"{text[:head]}...{text[head + 3 - longest :]}"


def suggestion(name: str, known: Iterable[str]) -> str:
    """Return ``"; did you mean 'x'? known: ..."`` for an unknown name."""
    names = sorted(known)
    return f"{nearest_name(name, names) or ';'} {known_names(names)}"


def known_names(known: Iterable[str]) -> str:
    """Return ``"known: ..."``, the names sorted, a long list cut."""
    names = sorted(known)
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return f"known: {', '.join(map(clipped, names[:MOST_NAMES])) or 'none'}{more}"


def nearest_name(name: str, known: Iterable[str]) -> str:
    """Return ``"; did you mean 'x'?"`` for an unknown name, or nothing if none is near."""
    if len(name) > LONGEST:  # difflib's time is quadratic
        return ""
    by_lower = {known_name.lower(): known_name for known_name in known}
    near = difflib.get_close_matches(name.lower(), by_lower, n=1)
    meant = by_lower[near[0]] if near else OTHER_WORDS.get(name.lower(), "")
    return f"; did you mean {clipped(meant)!r}?" if meant in by_lower.values() else ""


def short_words(text: str) -> str:
    """Text whose unbroken words are clipped: a sentence has none so long but what it quotes."""
    if len(text) <= LONGEST:
        return text
    return re.sub(rf"\S{{{LONGEST + 1},}}", lambda word: clipped(word[0]), text)


def shown_value(value: Any) -> str:
    """What `repr` says of a value, on one line and of at most 80 characters."""
    try:
        text = " ".join(repr(value).split())
    except (RecursionError, ValueError):  # nested without end; an integer of too many digits
        return f"of type {type(value).__name__}, too long to show"
    return text if len(text) <= 80 else f"{text[:77]}..."


def listed(names: Sequence[str]) -> str:
    """Names in a sentence: ``a, b and c``."""
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def aligned(rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """Rows of a table as lines, the first column to the left, the others to the right."""
    first, *widths = (max(map(len, column)) for column in zip(*rows, strict=True))
    for name, *others in rows:
        right = [cell.rjust(width) for cell, width in zip(others, widths, strict=True)]
        yield "  ".join([name.ljust(first), *right]).rstrip()
