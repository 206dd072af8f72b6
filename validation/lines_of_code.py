"""Lines of code of the core and of the lab: no blank lines, no comments, no docstrings.

Run ``python -m validation.lines_of_code``.
"""

from __future__ import annotations

import io
import tokenize
from collections import Counter
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1] / "quasistatic_ref"
LAYOUT = {
    tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT,
    tokenize.ENCODING, tokenize.ENDMARKER,
}  # fmt: skip


def lines_of_code(text: str) -> int:
    """Lines on which a token of a statement stands that is more than a string."""
    lines: set[int] = set()
    statement: list[tokenize.TokenInfo] = []
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in LAYOUT:
            statement.append(token)
        elif token.type == tokenize.NEWLINE:
            if any(part.type != tokenize.STRING for part in statement):
                lines.update(n for t in statement for n in range(t.start[0], t.end[0] + 1))
            statement = []
    return len(lines)


def main() -> None:
    """One line for each storey, and for the rooms of each."""
    rooms: Counter[str] = Counter()
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(PACKAGE).parts
        room = "/".join(parts[: 2 if parts[0] == "lab" else 1]).removesuffix(".py")
        rooms[room] += lines_of_code(path.read_text(encoding="utf-8"))
    lab = sum(count for room, count in rooms.items() if room.startswith("lab"))
    print(f"core {rooms.total() - lab}\nlab  {lab}")
    for room, count in sorted(rooms.items()):
        print(f"  {room:16} {count:6}")


if __name__ == "__main__":
    main()
