"""docs/contributing.md: what it says to be written twice is there to be looked at."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "contributing.md").read_text(encoding="utf-8")


def places():
    """Every file and folder that the section names, from the root or from the package."""
    section = PAGE.partition("\n## What is written twice on purpose\n")[2].partition("\n## ")[0]
    return re.findall(r"`([\w/]+(?:\.py|/))`", section)


def test_what_is_written_twice_stands_where_the_page_says():
    missing = [
        place
        for place in places()
        if not any((root / place).exists() for root in (ROOT, ROOT / "quasistatic_ref"))
    ]
    assert len(places()) > 40
    assert missing == []
