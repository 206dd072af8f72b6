"""The ports' formulas are changed one place at a time, and names have places in them."""

import json
import re
import sys

import pytest

from quasistatic_ref.lab.vectors.check.table import MISTAKES
from quasistatic_ref.lab.vectors.tables import free_body
from validation.make.fingerprints import fingerprint, subjects
from validation.make.port_changes import RULES, changes, switched_line
from validation.make.port_mutants import differs, kept_apart, subjects_of_mistake
from validation.make.program_changes import changes as program_changes
from validation.tools.port_programs import Program, Question, replies
from validation.tools.ports import PORTS, texts

LIBRARIES = {
    "go": {"bufio", "encoding/json", "fmt", "math", "math/big", "os", "path/filepath", "sort"},
    "cpp": {
        *("algorithm", "array", "cmath", "fstream", "iostream", "map", "numeric", "stdexcept"),
        *("string", "vector", "gmpxx.h", "nlohmann/json.hpp"),
    },
}
INCLUDED = {
    "go": re.compile(r'^(?:import |\t)"([\w/]+)"$', re.MULTILINE),
    "cpp": re.compile(r"^#include <(.*)>$", re.MULTILINE),
}


@pytest.mark.parametrize("name", LIBRARIES)
def test_a_port_needs_nothing_of_this_package(name):
    included = {one for text in texts(name).values() for one in INCLUDED[name].findall(text)}
    assert included == LIBRARIES[name]


@pytest.mark.parametrize("name", LIBRARIES)
def test_a_change_is_of_one_line_and_each_kind_occurs(name):
    found = list(changes(PORTS / name))
    assert {one.kind for one in found} == {kind for kind, _, _ in RULES}
    assert len({one.name for one in found}) == len(found) > 1000
    for one in found:
        lines = texts(name)[one.file].splitlines(keepends=True)
        assert lines[one.line] == one.old != one.new
        assert one.new.count("\n") == 1
    apart = sum(kept_apart(one.name) for one in found)
    assert 0.4 * len(found) < apart < 0.6 * len(found)


def test_a_line_in_cpp_is_the_old_one_or_the_new_one():
    first = next(one for one in changes(PORTS / "cpp") if one.old.strip().startswith("double w ="))
    old, new = first.old.strip(), first.new.strip()
    assert switched_line(first, 7) == (
        f"double w = MUTANT == 7 ? double({new[11:-1]}) : double({old[11:-1]});"
    )


def test_an_answer_without_a_number_is_another_answer():
    asked = Question("qp/1", "qp", {}, {"flags": {}})
    one, rounded, none = (f'{{"output": {{"b": [2, {x}]}}}}' for x in ("1", "1.0000001", "null"))
    assert not differs(asked, one, rounded)
    assert differs(asked, one, none)
    assert differs(asked, none, one)


def test_a_quaternion_and_its_opposite_are_one_answer():
    case = {"mechanism": {"bodies": [free_body()]}}
    asked = Question("integrate/1", "integrate", case, {"flags": {}})
    turn = [0.5, 0.5, 0.5, 0.5]
    answers = ([0.0, 1.0, 2.0, *turn], [0.0, 1.0, 2.0, *(-x for x in turn)],
               [0.0, 1.0, 2.0, None, *turn[1:]], [-0.5, 1.0, 2.0, *turn])  # fmt: skip
    one, opposite, none, other = (json.dumps({"output": {"q": q}}) for q in answers)
    assert not differs(asked, one, opposite)
    assert differs(asked, one, none)
    assert differs(asked, none, one)
    assert differs(asked, one, other)


@pytest.mark.parametrize("end", ["sys.exit(1)", "os.kill(os.getpid(), 9)", "print('{', end='')"])
def test_after_a_case_without_an_answer_a_program_is_asked_the_next(end, tmp_path):
    path = tmp_path / "program"
    path.write_text(f"""#!{sys.executable}
import json, os, sys
print("mine", flush=True)
for one in map(json.loads, sys.stdin):
    if one["input"] == "bad":
        {end}
        sys.exit(1)
    print(json.dumps({{"id": one["id"]}}), flush=True)
""")
    path.chmod(0o700)
    inputs = {"qp": "bad good bad good bad good", "rows": "good bad good"}
    asked = [
        Question(f"{layer}/{number}", layer, case, {})
        for layer, cases in inputs.items()
        for number, case in enumerate(cases.split())
    ]
    given = replies(Program(path), asked)
    # Nothing more is asked of qp after its third.
    assert {one.id: given.get(one.id) for one in asked} == {
        "qp/0": "", "qp/1": '{"id": "qp/1"}', "qp/2": "", "qp/3": '{"id": "qp/3"}', "qp/4": "",
        "qp/5": None, "rows/0": '{"id": "rows/0"}', "rows/1": "", "rows/2": '{"id": "rows/2"}',
    }  # fmt: skip


def test_every_mistake_that_is_named_computes_something():
    for one in MISTAKES:
        if {*one.predictions} - {"derivative"}:
            assert subjects_of_mistake(one.name), one.name
    assert "M in H" in subjects_of_mistake("inertia not turned into the world")


@pytest.mark.parametrize("name", LIBRARIES)
def test_of_every_line_that_can_be_changed_it_is_known_what_it_computes(name):
    known = {one for change in program_changes() for one in fingerprint(change)[0]}
    assert len(known) == 30
    for change in changes(PORTS / name):
        assert known.issuperset(subjects(name, change.place, change.old))
