"""The ports need nothing of this package, and are asked one case after the other."""

import re
import sys

import pytest

from validation.tools.port_programs import Program, Question, replies
from validation.tools.ports import texts

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
