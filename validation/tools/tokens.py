"""How much code there is, by part: ``python -m validation.tools.tokens [FOLDER]``.

A token is a name, a number, a string, an operator or a bracket. Comments, docstrings and layout
do not count, so a line more costs nothing, and two lines joined save nothing.
"""

import ast
import io
import re
import subprocess
import sys
import tokenize
from collections import Counter
from pathlib import Path, PurePosixPath

COUNTED = {tokenize.NAME, tokenize.NUMBER, tokenize.STRING, tokenize.OP}
F_STRING = getattr(tokenize, "FSTRING_START", tokenize.STRING)
"""Where an f-string begins, from Python 3.12 on; before, it is one string."""

STRING = r"\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'|`(?:\\.|[^`\\])*`"
C_LIKE = re.compile(
    rf"/\*.*?\*/|//[^\n]*|({STRING}|[A-Za-z_]\w*|\d[\w.]*|[^\sA-Za-z_\d])", re.DOTALL
)
TOML = re.compile(
    r"#[^\n]*|(\"(?:\\.|[^\"\\])*\"|'[^']*'|[A-Za-z_][\w-]*|\d[\w.+-]*|[^\sA-Za-z_\d])"
)
SUFFIXES = {".py", ".c", ".h", ".js"}
ELSEWHERE = {"docs", "models", ".github"}
"""Folders whose code belongs to pages and scenes."""


def python_tokens(text: str) -> int:
    """Tokens of Python without its docstrings."""
    docstrings = {
        (node.lineno, node.col_offset)
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    }
    count = 0
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type in COUNTED | {F_STRING} and token.start not in docstrings:
            count += 1
    return count


def tokens(path: Path) -> int:
    """Tokens of one file."""
    text = path.read_text("utf-8")
    if path.suffix == ".py":
        return python_tokens(text)
    pattern = TOML if path.suffix == ".toml" else C_LIKE
    return sum(found.group(1) is not None for found in pattern.finditer(text))


def is_code(name: str) -> bool:
    """Whether a file of the checkout counts: code, and the TOML of the package."""
    path = PurePosixPath(name)
    table = path.suffix == ".toml" and path.parts[0] == "quasistatic_ref"
    return (
        (path.suffix in SUFFIXES or table)
        and path.parts[0] not in ELSEWHERE
        and "data" not in path.parts[:-1]
    )


def part(name: str) -> str:
    """The part of the project that a file belongs to."""
    top, *rest = PurePosixPath(name).parts
    if top == "tests":
        return "tests"
    if top != "quasistatic_ref":
        return "validation and tools"
    return rest[0] if rest[0] in {"optional", "lab", "cli"} else "core"


def main() -> None:
    """One line for each part, and their sum."""
    root = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    listed = subprocess.run(
        ["git", "-C", str(root), "ls-files"], capture_output=True, text=True, check=True
    )
    parts = Counter()
    for name in filter(is_code, listed.stdout.splitlines()):
        parts[part(name)] += tokens(root / name)
    for name, count in [*sorted(parts.items()), ("sum", parts.total())]:
        print(f"{name:22} {count:9,}")


if __name__ == "__main__":
    main()
