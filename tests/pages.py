"""What stands in pages of README and docs/: printed output, and commands."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "quasistatic_ref"
EXAMPLES = ROOT / "docs" / "examples"


def fenced(page, languages):
    """The text of each block of a page in one of some languages, as in ``"sh|bash"``."""
    return re.findall(rf"^```(?:{languages})\n(.*?)^```", page, re.MULTILINE | re.DOTALL)


def flat(text):
    """A text in one line, single spaces."""
    return " ".join(text.split())


def printed_blocks(page):
    """The fenced blocks of printed text on a page, without their indents."""
    blocks = re.findall(r"^( *)```(?:text|output)\n(.*?)^\1```$", page, re.MULTILINE | re.DOTALL)
    return [re.sub(rf"^{indent}", "", block, flags=re.MULTILINE) for indent, block in blocks]


def shell_lines(page):
    """Every command line in the fenced shell blocks of a page, without prompts and comments."""
    lines = "".join(fenced(page, "sh|bash|console")).splitlines()
    stripped = [line.removeprefix("$ ").partition(" #")[0].strip() for line in lines]
    return [line for line in stripped if line and not line.startswith("#")]


def downloads(folder):
    """Name -> text of the files in a folder of docs/examples."""
    return {p.name: p.read_text("utf-8") for p in sorted((EXAMPLES / folder).glob("*"))}


def named_files(page):
    """Name -> text of the blocks of a page whose first line is a comment that names a file."""
    blocks = re.findall(r"^```\w+\n(# ([\w.]+\.\w+)\b.*?)^```$", page, re.MULTILINE | re.DOTALL)
    xml = re.findall(r"^```\w+\n(<!-- ([\w.]+\.\w+) -->.*?)^```$", page, re.MULTILINE | re.DOTALL)
    return {name: text for text, name in (*blocks, *xml)}
