"""A default run calls functions in the order, and by the callers, that contributing.md names."""

import re
import sys
from pathlib import Path

import quasistatic_ref
from quasistatic_ref.scenario.scenario import load_scenario

PACKAGE = Path(quasistatic_ref.__file__).parent
PAGE = PACKAGE.parent / "docs" / "contributing.md"
BRANCH = re.compile(r"^( *)(\w+(?:\.\w+)?) +(\w+/\w+\.py)", re.MULTILINE)
ITEM = re.compile(r"^\d+\. (.*)$", re.MULTILINE)
FILE = re.compile(r"`([\w/]+\.py)`")
NAME = re.compile(r"`(\w+(?:\.\w+)?)`")
NOT_CALLED = ["verify"]
"""Named as a function that no step calls."""


SECTION = PAGE.read_text().partition("## Read the code")[2].partition("\n## ")[0]


def called(name):
    """The function of a name: of a class its constructor."""
    return f"{name}.__init__" if name[0].isupper() and "." not in name else name


def named():
    """(name, the files of its item) of each function of the list."""
    for words in ITEM.findall(SECTION):
        files = [f"{PACKAGE}/{file}" for file in FILE.findall(words)]
        for name in NAME.findall(FILE.sub("", words)):
            yield called(name), files


def branches():
    """(file, name) of each function of the tree, with that of the one it is indented below."""
    above = {}
    for indent, name, file in BRANCH.findall(SECTION.partition("```text")[2].partition("```")[0]):
        function = f"{PACKAGE}/{file}", called(name)
        above[len(indent)] = function
        if indent:
            yield function, above[len(indent) - 4]


def test_a_run_first_calls_functions_in_the_order_of_the_reading_path():
    first_calls = {}
    tree = dict(branches())
    callers = {function: set() for function in tree}

    def note(frame, event, _):
        if event != "call":
            return
        function = frame.f_code.co_filename, frame.f_code.co_qualname
        first_calls.setdefault(function, len(first_calls))
        while function in tree and (frame := frame.f_back):
            callers[function].add((frame.f_code.co_filename, frame.f_code.co_qualname))

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
    in_order = [name for name in places if name not in NOT_CALLED]
    assert in_order == sorted(in_order, key=places.get)
    assert len(tree) > 20
    assert [one for one, caller in tree.items() if caller not in callers[one]] == []
