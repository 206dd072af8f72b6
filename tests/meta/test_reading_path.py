"""A run calls functions in the order, and by the callers, that contributing.md names.

How often the exact method walks after a backend's answer depends on the last bits of that answer,
and so on the processor. A cold start of the method always walks.
"""

import re
import sys
from collections import defaultdict
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


def named(of=""):
    """(name, the files of its item) of each function of the list, or of the items that name one."""
    for words in filter(lambda item: of in item, ITEM.findall(SECTION)):
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


TREE = dict(branches())


def calls(*settings):
    """Function -> the place of its first call in a step of the grasp; function -> its callers."""
    first_calls = {}
    callers = defaultdict(set)

    def note(frame, event, _):
        if event != "call":
            return
        function = frame.f_code.co_filename, frame.f_code.co_qualname
        first_calls.setdefault(function, len(first_calls))
        while function in TREE and (frame := frame.f_back):
            callers[function].add((frame.f_code.co_filename, frame.f_code.co_qualname))

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        load_scenario("bunny_grasp", settings, steps=1).run(progress=False)
    finally:
        sys.setprofile(before)
    return first_calls, callers


def places(first_calls):
    """Name -> the place of its first call, of each name of the list that was called."""
    return {
        name: min(found)
        for name, files in named()
        if (found := [first_calls[file, name] for file in files if (file, name) in first_calls])
    }


def test_a_run_first_calls_functions_in_the_order_of_the_reading_path():
    first_calls, callers = calls()
    of_default = places(first_calls)
    of_cold = places(calls('solver.backend="none"')[0])
    names = [name for name, _ in named()]
    assert [name for name in names if name not in of_default | of_cold] == NOT_CALLED
    walk = [name for name, _ in named("_walk")]
    for called, wanted in ((of_cold, walk), (of_default, [*of_default.keys() - walk])):
        in_order = [name for name in called if name in wanted]
        assert in_order == sorted(wanted, key=called.get)
    assert len(TREE) > 20
    assert [one for one, caller in TREE.items() if caller not in callers[one]] == []
