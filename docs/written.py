"""What pages repeat is written between comment markers: ``python -m docs.written [--check]``.

``<!-- code FILE OBJECT -->`` stands before a function, a class or a method of a source file, and
``<!-- code FILE OBJECT | from WORDS | to WORDS -->`` before its lines from one with some words to
one with others, or ``before`` it.
``<!-- number NAME -->`` stands before a number of the committed results, in a line of text. Each
ends with ``<!-- end -->``. With ``--check`` nothing is written, and the exit status is 1 if a page
would change.
"""

import ast
import json
import re
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
CODE = re.compile(
    r"(<!-- code (\S+) (\S+)(?: \| from ([^|]+?) \| (to|before) ([^|]+?))? -->\n).*?(<!-- end -->)",
    re.DOTALL,
)
NUMBER = re.compile(r"(<!-- number (\S+) -->).*?(<!-- end -->)")


def result(name):
    """A committed result."""
    return json.loads((ROOT / "validation" / "results" / f"{name}.json").read_text("utf-8"))


def numbers():
    """Each number by its name, as a page shows it."""
    everything = result("reality")["pairs"]["all"]
    shown = {}
    for key in ("error", "published"):
        for end in ("low", "mean", "high"):
            place, angle = everything[key][end]
            shown[f"{key}-{end}-mm"] = f"{place:.2f}"
            shown[f"{key}-{end}-deg"] = f"{angle:.2f}"
    return shown


def code_of(file, name, first=None, ends=None, last=None):
    """The source of an object, or some of its lines, in a fence."""
    text = (ROOT / file).read_text("utf-8")
    node = ast.parse(text)
    for part in name.split("."):
        node = next(one for one in node.body if getattr(one, "name", None) == part)
    begin = min([node.lineno, *(one.lineno for one in node.decorator_list)])
    lines = text.splitlines()[begin - 1 : node.end_lineno]
    if first:
        start = next(k for k, line in enumerate(lines) if first in line)
        stop = next(k for k, line in enumerate(lines) if k >= start and last in line)
        lines = lines[start : stop + (ends == "to")]
    return "```python\n" + textwrap.dedent("\n".join(lines)).rstrip() + "\n```\n"


def written(text, shown):
    """A page with what its markers ask for."""
    text = CODE.sub(lambda m: m[1] + code_of(*m.group(2, 3, 4, 5, 6)) + m[7], text)
    return NUMBER.sub(lambda m: m[1] + shown[m[2]] + m[3], text)


def main(check):
    """Write the pages, or name those that would change."""
    shown = numbers()
    status = 0
    for path in PAGES:
        before = path.read_text("utf-8")
        after = written(before, shown)
        if after != before:
            print(path.relative_to(ROOT))
            status = int(check)
            if not check:
                path.write_text(after, "utf-8")
    return status


if __name__ == "__main__":
    sys.exit(main("--check" in sys.argv[1:]))
