"""Files and names stay short enough to be read at once."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
LINES, LETTERS, PAGE = 300, 70, 100
FILES = [
    path
    for folder in ("quasistatic_ref", "tests", "validation", "docs")
    for path in sorted((ROOT / folder).rglob("*.py"))
]


def test_no_file_has_more_lines_than_are_read_at_once():
    lines = {str(path.relative_to(ROOT)): path.read_text("utf-8").count("\n") for path in FILES}
    assert {name: n for name, n in lines.items() if n > LINES} == {}
    assert len(lines) > 900


def test_the_paper_s_page_stays_a_page():
    page = (ROOT / "quasistatic_ref" / "step" / "problem.py").read_text("utf-8")
    assert 50 < page.count("\n") <= PAGE


def test_no_name_of_a_test_is_longer_than_a_line_of_a_report():
    names = [
        name
        for path in FILES
        if "tests" in path.parts
        for name in re.findall(r"^ *def (test_\w+)", path.read_text("utf-8"), re.MULTILINE)
    ]
    assert [name for name in names if len(name) > LETTERS] == []
    assert len(names) > 1000
