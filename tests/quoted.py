"""Numbers that a page of the documentation quotes, against the results that they come from."""

import re
from functools import cache
from pathlib import Path

NUMBER = re.compile(r"(?<![\w.])\d[\d,.]*(?:e[+-]?\d+)?")
NO_QUOTE = re.compile(r"`[^`]*`|\]\([^)]*\)")
"""Code and addresses of links."""
WORDS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


def word(number):
    """A small number as a word."""
    return WORDS[number] if number < len(WORDS) else f"{number:,}"


def flat(text):
    """A text in one line, single spaces."""
    return " ".join(text.split())


def printed(page):
    """The fenced blocks of printed text on a page, without their indents."""
    blocks = re.findall(r"^( *)```text\n(.*?)^\1```$", page, re.MULTILINE | re.DOTALL)
    return [re.sub(rf"^{indent}", "", block, flags=re.MULTILINE) for indent, block in blocks]


def stale(page, phrases):
    """The phrases, as they ought to read, that do not stand on a page."""
    return [phrase for phrase in phrases if phrase not in flat(page)]


def unheld(page, phrases, constants):
    """Numbers on a page that stand in none of the phrases, and are no constants of its text."""
    rest = flat("\n".join(line for line in page.splitlines() if not line.startswith("|")))
    for phrase in sorted(phrases, key=len, reverse=True):
        rest = rest.replace(phrase, " ")
    return list(NUMBER.findall(NO_QUOTE.sub(" ", constants.sub(" ", rest))))


# -- Where numbers come from ---------------------------------------------------------------------
ROOT = Path(__file__).parents[1]


def number(text):
    """A number as it is written in a table: 1,277, 40 % or 0.21."""
    return float(text.replace(",", "").rstrip(" %"))


@cache
def cells(file, section=""):
    """Rows of the first Markdown table after a heading that starts so; each by its column."""
    text = (ROOT / file).read_text("utf-8")
    at = re.search(rf"^#+ {re.escape(section)}.*$", text, re.MULTILINE) if section else None
    assert at or not section, f"{file} has no heading {section}"
    rows = re.search(r"(?:^\|.*\n)+", text[at.end() if at else 0 :], re.MULTILINE)[0].splitlines()
    split = [[cell.strip() for cell in row.strip("|").split(" | ")] for row in rows]
    head = [cell.strip() for cell in rows[0].strip("|").split(" | ")]
    return [dict(zip(head, row, strict=True)) for row in split[2:]]


def cell(file, section, row, column):
    """One number of such a table: of the row whose first cells are these."""
    row = (row,) if isinstance(row, str) else row
    (found,) = [c for c in cells(file, section) if tuple(c.values())[: len(row)] == row]
    return number(found[column])


def claim(name, quantity):
    """What a claim measured, in the committed claims."""
    return cell("validation/results/claims.md", f"{name}: ", quantity, "measured")


def said(file, pattern):
    """The groups of a pattern in a committed text, as numbers."""
    found = re.search(pattern, (ROOT / file).read_text("utf-8"))
    assert found, f"{file} has no {pattern}"
    return [number(group) for group in found.groups()]
