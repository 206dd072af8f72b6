"""What is expected and what is given, side by side."""

from quasistatic_ref.lab.vectors.check.compare import leaves
from quasistatic_ref.lab.vectors.trees import Json

LINES = 60
"""At most so many numbers of one case are shown."""


def side_by_side(expected: Json, answer: Json) -> list[tuple[str, ...]]:
    """The table of all numbers that differ, its header first; then how many are the same."""
    ours = {_place(path): value for path, value in leaves(expected)}
    theirs = {_place(path): value for path, value in leaves(answer)}
    rows = [("place", "expected", "given", "difference")]
    other = [at for at in {**ours, **theirs} if _text(ours, at) != _text(theirs, at)]
    for at in other[:LINES]:
        change = _change(ours.get(at), theirs.get(at))
        rows.append((at, _text(ours, at), _text(theirs, at), change))
    more = f"{len(other) - LINES} more that differ, " if len(other) > LINES else ""
    return [*rows, (f"{more}{len(ours) - len(set(other) & set(ours))} the same", "", "", "")]


def _place(path: str) -> str:
    return path.removeprefix(".") or "output"


def _change(expected: Json, answer: Json) -> str:
    """The answered number less the expected one; empty unless both are numbers."""
    if any(isinstance(v, bool) or not isinstance(v, int | float) for v in (expected, answer)):
        return ""
    return f"{float(answer) - float(expected):.3g}"


def _text(values: dict[str, Json], place: str) -> str:
    return repr(values[place])[:40] if place in values else "-"
