"""What stands below the axes of a figure, in as many lines as there is room for."""

import re
from collections.abc import Sequence
from typing import Any

LETTER = 0.62
"""Width of a letter over the size of its font [-]: most letters are slimmer."""
WORD = re.compile(r"(?:\$[^$]*\$|\[[^\]]*\]|[^\s$\[])+")
"""What a line may not break: a formula, a unit, a word."""
QUIET = re.compile(r"\\(?:mathrm|[,;!])|[\\${}_^]")
"""Signs of a formula that take no room."""


def wrapped(text: str, width: float) -> str:
    """A text in lines no wider than `width` [sizes of the font], where words allow."""
    lines: list[str] = []
    for word in WORD.findall(text):
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and LETTER * len(QUIET.sub("", longer)) > width:
            lines.append(word)
        else:
            lines[-1:] = [longer]
    return "\n".join(lines)


def caption(h: float, cone: str = "pyramid") -> str:
    """What each figure of a run says of it: time step [s] and friction cone."""
    return f"h = {1e3 * h:g} ms, " + (cone if cone == "frictionless" else f"friction {cone}")


def note_below(grid: Sequence[Any], text: str) -> None:
    """A sentence below all axes of a figure, or of a part of one, in lines that fit it."""
    part = grid[0].get_figure(root=False)
    note = part.supxlabel("", fontsize=grid[0].xaxis.label.get_fontsize())
    note.set_text(fitted(text, part, note.get_fontsize()))


def fitted(text: str, part: Any, size: float) -> str:
    """A text in lines that fit a figure or part of one, in a font of a size [pt]."""
    return wrapped(text, part.bbox.width / (size * part.get_figure(root=True).dpi / 72))
