"""The plain program with lines of it replaced."""

import sys
from collections.abc import Callable
from functools import cache
from importlib.resources import files
from types import CodeType, ModuleType

from quasistatic_ref.lab import program as plain_program
from quasistatic_ref.lab.vectors.expected import Json

MODULES = (
    *("number", "rotation", "mechanism", "integration", "curved", "distance", "candidates"),
    *("rows", "wrench", "optimum", "forces", "step", "derivative", "layers"),
)
"""Files of the program, each after those that it imports from."""

Program = Callable[[str, Json], Json]
"""(layer, input) -> output."""


@cache
def text_of_file(file: str) -> str:
    """The text of a file of the program."""
    return (files(plain_program) / file).read_text("utf-8")


@cache
def _code(file: str, text: str) -> CodeType:
    return compile(text, file, "exec")


def patched_texts(patch: str, text_of: Callable[[str], str] = text_of_file) -> dict[str, str]:
    """The files that a patch changes.

    Parameters
    ----------
    patch : str
        A file and a colon, then its lines: those after ``-`` are replaced by those after ``+``.
    text_of : callable
        The text of a file; by default of the plain program.

    Raises
    ------
    ValueError
        If a line after ``-`` does not stand in its file, or more than once.
    """
    found: dict[str, list[str]] = {}
    lines: list[str] = []
    at = 0
    margin = ""
    for line in patch.splitlines():
        sign, _, text = line.partition(" ")
        if sign == "-":
            places = [i for i, known in enumerate(lines) if known.strip() == text]
            if len(places) != 1:
                raise ValueError(f"{text!r} stands {len(places)} times in its file")
            at = places[0]
            margin = lines.pop(at).removesuffix(text)
        elif sign == "+":
            lines.insert(at, margin + text)
            at += 1
        else:
            file = sign.removesuffix(":")
            lines = found.setdefault(file, text_of(file).splitlines())
    return {file: "\n".join(text) + "\n" for file, text in found.items()}


@cache
def program(patch: str = "") -> Program:
    """The program, with a patch or without: a copy of its own."""
    return program_of(patched_texts(patch))


def program_of(changed: dict[str, str]) -> Program:
    """The program with other texts of some of its files: a copy of its own.

    Parameters
    ----------
    changed : dict of str to str
        By file, as ``rows.py``.
    """
    name = f"{plain_program.__name__}_{len(sys.modules)}_copy"
    copies = {name: ModuleType(name)}
    sys.modules[name] = copies[name]
    try:
        for module in MODULES:
            copy = ModuleType(f"{name}.{module}")
            copy.__package__ = name
            sys.modules[copy.__name__] = copies[copy.__name__] = copy
            file = f"{module}.py"
            exec(_code(file, changed.get(file) or text_of_file(file)), vars(copy))
    finally:
        for one in copies:
            del sys.modules[one]

    def answer(layer: str, case: Json) -> Json:
        known = {**copy.LAYERS, **copy.TO_SIX_DIGITS}
        return copy.plain(known[layer](case))

    return answer
