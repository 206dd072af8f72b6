"""Which functions of a port do what is said of failing cases: those that run in such cases alone.

Each function of a port notes that it runs (a line that a program adds). So each committed case has
its functions. Of a sentence of ``compare``, the cases with the words that it says are taken for
those that fail, the others of the layer and all of the layers before it for right ones. A
function that runs in a of the n failing cases, and in b right ones, scores a / sqrt(n (a + b)),
Ochiai's coefficient (Abreu et al., "On the accuracy of spectrum-based fault localization", 2007).
The functions of the highest scores are said: no list of words and functions is written by hand.
"""

import json
import re
import tempfile
from collections import Counter
from collections.abc import Mapping
from functools import cache
from math import sqrt
from pathlib import Path

from quasistatic_ref.lab.oracle.words import Words, contact_words, pair_words, side_words
from quasistatic_ref.lab.program.rotation import frame
from quasistatic_ref.lab.vectors.expected import Json
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
def words_by_case(layer: str) -> dict[str, Words]:
    """By committed case, its words."""
    asked = committed_questions(layer)
    return {q.id: frozenset(_words(q.case, q.record["output"])) for q in asked}


def _words(case: Json, output: Json) -> set[str]:
    found = {f"cone: {case['cone'].partition('-')[0]}"} if "cone" in case else set()
    for body in case.get("mechanism", {}).get("bodies", []):
        if body["joint"] != "fixed" and "mimic" not in body:
            how = "actuated" if body.get("actuated") else "un-actuated"
            found |= {f"joint: {body['joint']}", f"{how} joint: {body['joint']}"}
    if "pose_alpha" in case:
        shapes = [case["alpha"], case["beta"]]
        poses = [frame(case["pose_alpha"]), frame(case["pose_beta"])]
        found |= pair_words(*shapes)
        several = isinstance(output["phi"], list)
        phi, n = (output[key] if several else [output[key]] for key in ("phi", "n"))
        for one, normal in zip(phi, n, strict=True):
            found |= side_words(shapes, poses, one, normal)
    for contact in case.get("contacts", output.get("contacts", [])):
        pairs = (one for one in case.get("pairs", []) if one["name"] == contact["pair"])
        found |= contact_words(case, contact, next(pairs, contact))
    return found


def places(name: str, layer: str, said: Words) -> list[str]:
    """The functions of a port that run most in the cases of which some words are said alone.

    Parameters
    ----------
    name : str
        The port's.
    layer : str
    said : set of str
        By ``compare`` of parts. Words that no case of the layer has tell nothing.
    """
    words = words_by_case(layer)
    meant = frozenset(
        one.replace("kinematics of joint:", "joint under the contact:") for one in said
    )
    if not meant <= frozenset().union(*words.values()):
        meant = frozenset()
    failing = {case for case, own in words.items() if not meant or not meant.isdisjoint(own)}
    ran = functions_by_case(name)
    inside: Counter[str] = Counter()
    outside: Counter[str] = Counter()
    for one in LAYERS[: LAYERS.index(layer) + 1]:
        for case, functions in ran[one].items():
            (inside if case in failing else outside).update(functions)
    score = {
        f: n / sqrt(len(failing & ran[layer].keys()) * (n + outside[f])) for f, n in inside.items()
    }
    return sorted(score, key=lambda f: (-score[f], f))[:MOST]
