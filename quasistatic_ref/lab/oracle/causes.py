"""What makes a step end as another program's does: classic mistakes, then bugs of one line.

Each is tried on steps that the other program took: the plain program with it has to end where that
program did, wherever it does not end where the reference does.
"""

import ast
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from types import FrameType
from typing import Any, NamedTuple

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.oracle.one_line_bugs import bugs_of
from quasistatic_ref.lab.vectors.check.patched import (
    Program,
    patched_texts,
    program,
    program_of,
    text_of_file,
)
from quasistatic_ref.lab.vectors.check.table import MISTAKES, PATCHES
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.model.system import System
from quasistatic_ref.step.arrays import Array

FILES = ("integration", "rows", "mechanism", "step", "rotation", "candidates", "distance", "curved")
"""Whose lines are tried, in this order; those of the solver and of wrenches move nothing."""
LAYERS = {
    "distance": "distance", "curved": "distance", "candidates": "selection", "rows": "rows",
    "mechanism": "jacobian", "rotation": "jacobian", "optimum": "qp", "integration": "integrate",
    "step": "step",
}  # fmt: skip
"""By file of the plain program; the functions below are of other layers."""
OBJECTIVE = "step (H and g)"
FUNCTIONS = {
    "rotation": "distance", "frame": "distance", "unit": "distance",
    "quaternion_product": "integrate", "tangents": "step (tangents)",
    "loads": OBJECTIVE, "objective": OBJECTIVE,
    "difference": OBJECTIVE, "way": OBJECTIVE, "cramer_solution": OBJECTIVE,
    "pose_in_world": "step (contacts)", "contacts_of": "step (contacts)",
}  # fmt: skip


LOOP = "for _ in range(1000):"
"""In the place of loops that a bug may keep from ending."""
FORCES = "forces(H, g, A, b, contacts, cone, h)"
"""What no motion follows from, and takes a third of a step."""


class Taken(NamedTuple):
    """A step that another program took.

    Parameters
    ----------
    case : dict
        As an input of the layer ``step``.
    q_next : ndarray, shape (n_q,)
        Where that program ended.
    allowed : float
        How far from there is near enough: the largest entry of the difference [m, rad].
    """

    case: Json
    q_next: Array
    allowed: float


class Cause(NamedTuple):
    """What would make a program end where the other one did.

    Parameters
    ----------
    layer : str
    name : str
        A classic mistake's; "" of a bug of one line.
    sentence : str
    changed : dict of str to str
        By file of the plain program, its text with the mistake.
    """

    layer: str
    name: str
    sentence: str
    changed: dict[str, str]


def layer_of(file: str, line: str) -> str:
    """The layer of a line of the plain program."""
    text = text_of_file(file)
    row = next(i for i, known in enumerate(text.splitlines(), 1) if known.strip() == line)
    for node in ast.parse(text).body:
        if isinstance(node, ast.FunctionDef) and node.lineno <= row <= (node.end_lineno or 0):
            return FUNCTIONS.get(node.name, LAYERS[Path(file).stem])
    return LAYERS[Path(file).stem]


def causes(
    system: System,
    wrong: Sequence[Taken],
    right: Sequence[Taken],
    say: Callable[[str], None] = lambda line: None,
) -> list[Cause]:
    """What explains all wrong steps and spoils no right one; classic mistakes before others.

    Parameters
    ----------
    system : System
    wrong, right : sequence of Taken
        `wrong` must not be empty; the first one is tried first.
    say : callable
        Called with a line on what is being done.
    """

    def explains(made: Program) -> bool:
        return all(ends_there(system, made, one) for one in (*wrong, *right))

    say("trying classic mistakes")
    found = []
    for mistake in MISTAKES:
        for patch in PATCHES.get(mistake.name, {}).get("step", ()):
            if "FACTOR" not in patch and explains(program(patch)):
                file, *lines = patch.splitlines()
                first = next(line[2:] for line in lines if line.startswith("- "))
                layer = layer_of(file.partition(":")[0], first)
                texts = patched_texts(patch)
                found.append(Cause(layer, mistake.name, mistake.sentence, texts))
                break
    if found:
        return found
    run = lines_run(wrong[0].case)
    known: set[tuple[str, str]] = set()
    for name in FILES:
        say(f"trying bugs of one line in {name}.py of the plain program")
        file = f"{name}.py"
        for bug in bugs_of(file, text_of_file(file), run.get(file, frozenset())):
            if (file, bug.old) not in known and explains(program_that_ends({file: bug.text})):
                known.add((file, bug.old))
                layer = FUNCTIONS.get(bug.function, LAYERS[name])
                sentence = f"as if, in {file} of the plain program, {bug.old!r} were {bug.new!r}"
                found.append(Cause(layer, "", sentence, {file: bug.text}))
        if found:
            break
    return found


def program_that_ends(changed: dict[str, str]) -> Program:
    """The plain program with other texts, whose loops end whatever the bug."""
    texts = {f: text_of_file(f) for f in ("distance.py", "optimum.py", "step.py")} | changed
    shorter = {f: t.replace("while True:", LOOP).replace(FORCES, "0") for f, t in texts.items()}
    return program_of(shorter)


def ends_there(system: System, made: Program, one: Taken) -> bool:
    """Whether a program ends a step where the other one did."""
    try:
        with np.errstate(all="ignore"):
            q = system.normalised(made("step", one.case)["q_next"])
            off = np.abs(system.difference(one.q_next, q)).max(initial=0.0)
    except (
        QuasistaticError,
        ArithmeticError,
        AttributeError,
        LookupError,
        NameError,
        TypeError,
        ValueError,
    ):
        return False  # a bug with which this step comes to nothing
    return bool(off <= one.allowed)


def lines_run(case: Json) -> dict[str, frozenset[int]]:
    """The lines of the plain program that a case runs through, by file."""
    made = program_of({})
    seen: set[tuple[str, int]] = set()

    def trace(frame: FrameType, event: str, argument: Any) -> Any:
        if frame.f_code.co_filename.removesuffix(".py") not in FILES:
            return None
        seen.add((frame.f_code.co_filename, frame.f_lineno))
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        made("step", case)
    finally:
        sys.settrace(before)
    files = {file for file, _ in seen}
    return {file: frozenset(n for f, n in seen if f == file) for file in files}
