"""Numbers that a page of the documentation quotes, against the results that they come from."""

import re
import tomllib
from functools import cache

from tests import quoted_sources
from tests.quoted_sources import ROOT

QUOTED = tomllib.loads((ROOT / "tests" / "quoted.toml").read_text("utf-8"))
"""Page -> its phrases with their numbers' sources, and rows for each entry of a source."""


class Filled(dict):
    """What phrases are filled with: each source is asked once, when a phrase names it."""

    def __missing__(self, name):
        self[name] = getattr(quoted_sources, name)()
        return self[name]


FILLED = Filled()

UNITS = "us|ms|s|minutes|hours|um|micrometres|mm|m|N|kg|g|N/m|mm/s|degrees|MB|GB|bytes"
COUNTED = "lines|points|steps|claims|files|problems|pushes|digits|rows|contacts|coordinates|entries"
WITH_UNIT = re.compile(rf"(?<![\w.^])[-+]?\d(?:[\d,.]*\d)?(?:e-?\d+)? (?:{UNITS}|{COUNTED})\b")
"""A number before a unit, or before what it counts."""


@cache
def expected_phrases(page):
    """The phrases of a page, as they ought to read."""
    phrases = [phrase.format_map(FILLED) for phrase in QUOTED[page]["phrases"]]
    for source, row in QUOTED[page].get("rows", {}).items():
        for name, own in FILLED[source].items():
            phrases.append(row.format(name=name, own=own))
    return phrases


def flat(text):
    """A text in one line, single spaces."""
    return " ".join(text.split())


def printed_blocks(page):
    """The fenced blocks of printed text on a page, without their indents."""
    blocks = re.findall(r"^( *)```text\n(.*?)^\1```$", page, re.MULTILINE | re.DOTALL)
    return [re.sub(rf"^{indent}", "", block, flags=re.MULTILINE) for indent, block in blocks]


def stale(page, phrases):
    """The phrases, as they ought to read, that do not stand on a page."""
    return [phrase for phrase in phrases if phrase not in flat(page)]


def outside(page, phrases):
    """The numbers with a unit on a page that are neither in one of these phrases nor in code."""
    prose = flat(re.sub(r"^( *)```.*?^\1```$", "", page, flags=re.MULTILINE | re.DOTALL))
    for phrase in phrases:
        prose = prose.replace(phrase, "...")
    return WITH_UNIT.findall(prose)
