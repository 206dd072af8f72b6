"""A default run first calls functions in the order in which contributing.md tells to read them."""

import re
import sys
from pathlib import Path

import quasistatic_ref
from quasistatic_ref.scenario.scenario import load_scenario

PACKAGE = Path(quasistatic_ref.__file__).parent
PAGE = PACKAGE.parent / "docs" / "contributing.md"
ITEM = re.compile(r"^\d+\. (.*)$", re.MULTILINE)
FILE = re.compile(r"`([\w/]+\.py)`")
NAME = re.compile(r"`(\w+(?:\.\w+)?)`")
NOT_CALLED = ["verify"]
"""Named as a function that no step calls."""


def named():
    """(name, the files of its item) of each function; the name of a class is its constructor's."""
    section = PAGE.read_text().partition("## Read the code")[2].partition("\n## ")[0]
    for words in ITEM.findall(section):
        files = [f"{PACKAGE}/{file}" for file in FILE.findall(words)]
        for name in NAME.findall(FILE.sub("", words)):
            is_class = name[0].isupper() and "." not in name
            yield (f"{name}.__init__" if is_class else name), files


def test_a_run_first_calls_functions_in_the_order_of_the_reading_path():
    first_calls = {}

    def note(frame, event, _):
        code = frame.f_code
        if event == "call":
            first_calls.setdefault((code.co_filename, code.co_qualname), len(first_calls))

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        load_scenario("bunny_grasp", steps=1).run(progress=False)
    finally:
        sys.setprofile(before)
    places = {}
    for name, files in named():
        found = [first_calls[file, name] for file in files if (file, name) in first_calls]
        places[name] = min(found, default=None)
    assert len(places) > 30
    assert [name for name, place in places.items() if place is None] == NOT_CALLED
    called = [name for name in places if name not in NOT_CALLED]
    assert called == sorted(called, key=places.get)
