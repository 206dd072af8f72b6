"""Names of tests stay short enough for a line of a report."""

import re
from pathlib import Path

LETTERS = 70
TESTS = Path(__file__).parents[1]


def test_no_name_of_a_test_is_longer_than_a_line_of_a_report():
    names = [
        name
        for path in sorted(TESTS.rglob("*.py"))
        for name in re.findall(r"^ *def (test_\w+)", path.read_text("utf-8"), re.MULTILINE)
    ]
    assert [name for name in names if len(name) > LETTERS] == []
    assert len(names) > 1000
