"""A default run executes what contributing.md tells a reader to read."""

import re
import sys
from pathlib import Path

import quasistatic_ref
from quasistatic_ref.scenario.scenario import load_scenario

PACKAGE = Path(quasistatic_ref.__file__).parent
PAGE = PACKAGE.parent / "docs" / "contributing.md"
FILE = re.compile(r"^\d+\. `([\w/]+\.py)`: (.*)$", re.MULTILINE)
NAME = re.compile(r"`([A-Z]?\w+(?:\.\w+)?)`")
NOT_CALLED = {"certify/certificate.py: verify"}
"""Named as a function that no step calls."""


def named():
    """``FILE: NAME`` of each function in the list; a class stands for its constructor."""
    section = PAGE.read_text().partition("## Read the code")[2].partition("\n## ")[0]
    for file, words in FILE.findall(section):
        for name in NAME.findall(words):
            yield (
                f"{file}: {name}.__init__"
                if name[0].isupper() and "." not in name
                else (f"{file}: {name}")
            )


def test_a_run_executes_the_functions_that_the_reading_path_names():
    codes = set()
    before = sys.getprofile()
    sys.setprofile(lambda frame, event, _: codes.add(frame.f_code))
    try:
        load_scenario("bunny_grasp", steps=1).run(progress=False)
    finally:
        sys.setprofile(before)
    executed = {f"{code.co_filename}: {code.co_qualname}" for code in codes}
    names = list(named())
    assert len(names) > 12
    assert {name for name in names if f"{PACKAGE}/{name}" not in executed} == NOT_CALLED
