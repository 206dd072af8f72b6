"""A run calls functions by the callers that contributing.md names."""

import re
import sys
import traceback
from collections import Counter, defaultdict
from contextlib import contextmanager
from pathlib import Path

import cvxpy

from quasistatic_ref import load_scenario
from quasistatic_ref.numbers import compiled
from tests.pages import PACKAGE, ROOT

PAGE = ROOT / "docs" / "contributing.md"
BRANCH = re.compile(r"^( *)(\w+(?:\.\w+)?) +([\w/]+\.py)", re.MULTILINE)
SECTION = PAGE.read_text().partition("## Read the code")[2].partition("\n## ")[0]


def function_named(name):
    """The function of a name: of a class its constructor."""
    return f"{name}.__init__" if name[0].isupper() and "." not in name else name


def branches():
    """(file, name) of each function of the tree, with that of the one it is indented below."""
    above = {}
    for indent, name, file in BRANCH.findall(SECTION.partition("```none")[2].partition("```")[0]):
        function = f"{PACKAGE}/{file}", function_named(name)
        above[len(indent)] = function
        if indent:
            yield function, above[len(indent) - 4]


TREE = dict(branches())


@contextmanager
def traced(note):
    """Calls within the block are noted, each by its frame."""
    before = sys.getprofile()
    sys.setprofile(lambda frame, event, _: note(frame) if event == "call" else None)
    try:
        yield
    finally:
        sys.setprofile(before)


def test_each_function_of_the_tree_is_called_by_the_one_above_it(monkeypatch):
    """Perhaps through others, and where compiled code does not stand in their place."""
    monkeypatch.setattr(compiled, "is_there", lambda word: False)
    callers = defaultdict(set)

    def note(frame):
        function = frame.f_code.co_filename, frame.f_code.co_qualname
        while function in TREE and (frame := frame.f_back):
            callers[function].add((frame.f_code.co_filename, frame.f_code.co_qualname))

    with traced(note):
        load_scenario("bunny_grasp", steps=1).run()
    assert 20 < len(TREE) < 27  # and load_scenario and Scenario.run, which nothing is above
    assert [one for one, caller in TREE.items() if caller not in callers[one]] == []


def test_a_step_enters_each_file_of_the_page_to_read():
    page = (ROOT / "docs" / "read_a_step.md").read_text()
    files = {f"{PACKAGE}/{f}" for f in re.findall(r"\]\(\.\./quasistatic_ref/([\w/]+\.py)\)", page)}
    assert len(files) == 13  # and the example
    assert len(page.split()) <= 700
    for minutes in page.split("## ")[1:]:
        assert sum(map(int, re.findall(r"\| (\d+) \|", minutes))) == 90
    entered = set()
    with traced(lambda frame: entered.add(frame.f_code.co_filename)):
        load_scenario("sphere_spin", steps=1).run()
    assert files <= entered
    for function in re.findall(r"`(\w+)`", page):
        assert any(re.search(rf"(def|class) {function}\b", Path(f).read_text()) for f in files)


def test_a_proved_step_is_read_in_at_most_46_files():
    """The third step of the grasp: the program is compiled, and what is constant is kept."""
    scenario = load_scenario("bunny_grasp")
    simulator = scenario.simulator()
    calls = Counter()
    start = scenario.system.q_start
    for k in range(3):
        target = scenario.targets((k + 1) * simulator.h)
        calls.clear()
        with traced(lambda frame: calls.update([frame.f_code.co_filename])):
            result = simulator.step(start, target)
        start = result.end
    assert result.solution.proved
    own = {file: n for file, n in calls.items() if file.startswith(f"{PACKAGE}/")}
    assert len(own) <= 46
    assert sum(own.values()) <= 700


def test_five_functions_lie_between_a_step_and_cvxpy(monkeypatch):
    """On the plain path, ``without_warnings`` left out: each is known by the word that it says."""
    scenario = load_scenario("sphere_spin")
    simulator = scenario.simulator()
    result = simulator.step(scenario.system.q_start)
    stacks = []
    solve = cvxpy.Problem.solve

    def noting(problem, **options):
        stacks.append([frame.name for frame in traceback.extract_stack()])
        return solve(problem, **options)

    monkeypatch.setattr(cvxpy.Problem, "solve", noting)
    simulator.step(result.end)
    (names,) = stacks
    between = names[names.index("step") + 1 : -1]
    assert between[1:3] == ["without_warnings", "_called_from"]
    functions = ["solution", "step_solution", "reply", "reply_with", "cvxpy_reply"]
    assert [between[0], *between[3:]] == functions
