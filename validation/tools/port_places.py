"""Which functions of a port do what is said of failing cases: those that run in such cases alone.

Each function of a port notes that it runs (a line that a program adds). So each committed case has
its functions. Of a sentence of ``vectors check``, the cases with the words that it says are taken
for those that fail, the others of the layer and all of the layers before it for right ones. A
function that runs in a of the n failing cases, and in b right ones, scores a / sqrt(n (a + b)),
Ochiai's coefficient (Abreu et al., "On the accuracy of spectrum-based fault localization", 2007).
The functions of the highest scores are said: no list of words and functions is written by hand.
"""

import json
import re
import tempfile
from collections import Counter
from collections.abc import Mapping, Sequence
from functools import cache
from math import sqrt
from pathlib import Path
from typing import NamedTuple

from quasistatic_ref.lab.vectors.check.words import Words, words_of_numbers
from quasistatic_ref.lab.vectors.layers import LAYERS
from validation.make.port_changes import BEGINS, FILES
from validation.tools.port_programs import Program, committed_questions, replies
from validation.tools.ports import compiler_errors, texts

MOST = 6
"""Functions that are said."""
SIGNATURE = {
    "go": re.compile(r"\s*func .*?\{(?=\s*$| )"),
    "cpp": re.compile(r".*?\)(?: const)?(?: : .*?)? \{"),
}
"""What a function begins with, up to its first statement."""
NOTED = {
    "go": "package main\n\nvar noted = map[string]bool{}\n\n"
    "func note(name string) { noted[name] = true }\n",
    "cpp": "#include <map>\n#include <string>\ninline std::map<std::string, bool> noted;\n"
    "inline void note(const std::string& name) { noted[name] = true; }\n",
}
ANSWERED = {
    "go": (
        "out.Encode(answered(c))",
        'line := answered(c); line["functions"] = noted; noted = map[string]bool{};'
        " out.Encode(line)",
    ),
    "cpp": (
        'std::cout << answered(asked["layer"], asked) << std::endl;',
        'json said = answered(asked["layer"], asked); said["functions"] = noted; noted.clear();'
        " std::cout << said << std::endl;",
    ),
}
"""How an answer is written, and how it is with the functions that made it."""
SENTENCE = re.compile(r"(?:(\S+) is wrong|no output is answered) with (.*?) in \d+ of \d+ failing")


class Condition(NamedTuple):
    """One of some words, or none of them."""

    words: Words
    wanted: bool = True


def noting(name: str) -> Mapping[str, str]:
    """The files of a port whose functions note that they run."""
    changed = {}
    for file, text in texts(name).items():
        lines = text.splitlines(keepends=True)
        for i, line in enumerate(lines if file in FILES[name] else ()):
            begins = BEGINS[name].match(line)
            signature = SIGNATURE[name].match(line)
            if begins and signature:
                head = line[: signature.end()]
                rest = line[signature.end() :]
                stop = ";" if name == "cpp" or rest.strip() else ""
                lines[i] = f'{head} note("{begins[1]}"){stop}{rest}'
        changed[file] = "".join(lines).replace(*ANSWERED[name])
    if name == "go":
        return changed | {"note.go": NOTED[name]}
    return changed | {"main.cpp": NOTED[name] + changed["main.cpp"]}


@cache
def functions_by_case(name: str) -> dict[str, dict[str, frozenset[str]]]:
    """By layer and case, the functions of a port that run."""
    found: dict[str, dict[str, frozenset[str]]] = {}
    with tempfile.TemporaryDirectory() as folder:
        program = Program(Path(folder) / name)
        if said := compiler_errors(name, program.path, noting(name)):
            raise SystemExit(said)
        for layer in LAYERS:
            lines = replies(program, committed_questions(layer))
            ran = {one: json.loads(line)["functions"] or () for one, line in lines.items()}
            found[layer] = {one: frozenset(functions) for one, functions in ran.items()}
    return found


@cache
def words_by_case(layer: str, field: str) -> dict[str, list[Words]]:
    """By committed case, the words of its numbers of a field."""
    return {
        q.id: [words for _, words in words_of_numbers(q.case, q.record["output"], field)]
        for q in committed_questions(layer)
    }


def conditions_of(layer: str, sentence: str) -> tuple[str, list[Condition]] | None:
    """The field and the conditions of a sentence of ``vectors check``; None of an empty one."""
    if not (said := SENTENCE.match(sentence)):
        return None
    field = said[1] or ""
    known = {
        word for case in words_by_case(layer, field).values() for word in frozenset().union(*case)
    }
    return field, [_condition(text, known) for text in said[2].split(" and ")]


def _condition(text: str, known: set[str]) -> Condition:
    """A condition from its text: a word, some of a kind, or none of some."""
    plain = {word.replace(":", ""): word for word in known}
    if text in plain:
        return Condition(frozenset({plain[text]}))
    for kind in {word.rpartition(": ")[0] for word in known}:
        values = text.removeprefix(f"{kind} ")
        words = frozenset(f"{kind}: {v}" for v in values.removeprefix("not ").split(" or "))
        if kind and values != text and words <= known:
            return Condition(words, not values.startswith("not "))
    raise SystemExit(f"no case has what is said: {text}")


def conditions_of_words(layer: str, words: Words) -> tuple[str, list[Condition]]:
    """Of what ``compare`` says of parts: words that no case of the layer has tell nothing."""
    meant = {word.replace("kinematics of joint:", "joint under the contact:") for word in words}
    known = frozenset().union(*(one for case in words_by_case(layer, "").values() for one in case))
    return "", [Condition(frozenset(meant))] if meant <= known else []


def places(name: str, layer: str, field: str, conditions: Sequence[Condition]) -> list[str]:
    """The functions of a port that run most in the cases of which some things are said alone.

    Parameters
    ----------
    name : str
        The port's.
    layer, field : str
        Of which that is said.
    conditions : sequence of Condition
    """

    def is_meant(case: str) -> bool:
        numbers = words_by_case(layer, field)[case]
        return any(
            all(words.isdisjoint(one.words) != one.wanted for one in conditions)
            for words in numbers
        )

    ran = functions_by_case(name)
    inside: Counter[str] = Counter()
    outside: Counter[str] = Counter()
    for one in LAYERS[: LAYERS.index(layer) + 1]:
        for case, functions in ran[one].items():
            (inside if one == layer and is_meant(case) else outside).update(functions)
    number = sum(map(is_meant, ran[layer]))
    score = {f: n / sqrt(number * (n + outside[f])) for f, n in inside.items()}
    return sorted(score, key=lambda f: (-score[f], f))[:MOST]
