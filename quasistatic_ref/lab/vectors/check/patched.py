"""The plain program with lines of it replaced, and the mistakes that it then makes.

mistakes.toml has the lines; a mistake predicts what the program answers with them.
"""

import sys
import tomllib
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from importlib.resources import files
from types import CodeType, ModuleType
from typing import Final

from quasistatic_ref.lab.vectors import check
from quasistatic_ref.lab.vectors import program as plain_program
from quasistatic_ref.lab.vectors.check.compare import parts
from quasistatic_ref.lab.vectors.check.mistake import Mistake, Prediction
from quasistatic_ref.lab.vectors.expected import Json

TABLE: Final = "mistakes.toml"
TIME_STEPS: Final = ("0.1", "0.05", "0.02", "0.01", "0.005", "0.002", "0.001")
"""h [s] that are tried where a layer does not know it."""
MODULES: Final = (
    *("rotation", "mechanism", "integration", "curved", "distance", "candidates"),
    *("rows", "wrench", "optimum", "step", "layers"),
)
"""Files of the program, each after those that it imports from."""

Program = Callable[[str, Json], Json]
"""(layer, input) -> output."""


@cache
def text_of(module: str) -> str:
    """The text of a file of the program."""
    return (files(plain_program) / f"{module}.py").read_text(encoding="utf-8")


@cache
def _code(module: str, text: str) -> CodeType:
    return compile(text, f"{module}.py", "exec")


def patched_texts(patch: str) -> dict[str, str]:
    """The files that a patch changes.

    Parameters
    ----------
    patch : str
        The name of a file, then its lines: those after ``-`` are replaced by those after ``+``.

    Raises
    ------
    ValueError
        If a line after ``-`` does not stand in its file, or more than once.
    """
    found: dict[str, list[str]] = {}
    lines: list[str] = []
    at, margin = 0, ""
    for line in patch.strip().splitlines():
        sign, _, text = line.partition(" ")
        if sign == "-":
            places = [i for i, known in enumerate(lines) if known.strip() == text]
            if len(places) != 1:
                raise ValueError(f"{text!r} stands {len(places)} times in its file")
            at = places[0]
            margin = lines[at].removesuffix(text)
            del lines[at]
        elif sign == "+":
            lines.insert(at, margin + text)
            at += 1
        else:
            module = sign.removesuffix(".py")
            lines = found.setdefault(module, text_of(module).splitlines())
    return {module: "\n".join(text) + "\n" for module, text in found.items()}


@cache
def program(patch: str = "") -> Program:
    """The program, with a patch or without: a copy of its own."""
    name = f"{plain_program.__name__}_{len(sys.modules)}_copy"
    texts = {module: text_of(module) for module in MODULES} | patched_texts(patch)
    copies = {name: ModuleType(name)}
    sys.modules[name] = copies[name]
    try:
        for module in MODULES:
            copy = ModuleType(f"{name}.{module}")
            copy.__package__ = name
            sys.modules[copy.__name__] = copies[copy.__name__] = copy
            exec(_code(module, texts[module]), vars(copy))
    finally:
        for one in copies:
            del sys.modules[one]

    def answer(layer: str, case: Json) -> Json:
        return copy.plain(copy.LAYERS[layer](case))

    return answer


def _predictions(patches: Sequence[str], layer: str) -> Prediction:
    """What each patch changes in the program's answer."""

    def predicted(case: Json, output: Json) -> Iterable[Json]:
        right = parts(program()(layer, case))
        for patch in patches:
            try:
                wrong = parts(program(patch)(layer, case))
            except (ArithmeticError, LookupError, TypeError, ValueError):
                continue  # a mistake that cannot be made in this case
            yield {name: value for name, value in wrong.items() if value != right.get(name)}

    return predicted


def _variants(lines: str) -> list[str]:
    """A patch for each value of h that it is to be tried with."""
    if "TIME_STEP" not in lines:
        return [lines]
    return [lines.replace("TIME_STEP", h) for h in TIME_STEPS]


@cache
def table() -> tuple[Json, ...]:
    """The entries of mistakes.toml; not to be changed."""
    text = (files(check) / TABLE).read_text(encoding="utf-8")
    return tuple(tomllib.loads(text)["mistake"])


def _mistake(entry: Json) -> Mistake:
    patches: dict[str, list[str]] = {}
    for patch in entry["patch"]:
        for layer in patch["layers"]:
            patches.setdefault(layer, []).extend(_variants(patch["lines"]))
    predictions = {layer: _predictions(lines, layer) for layer, lines in patches.items()}
    return Mistake(entry["name"], entry["sentence"], predictions)


PATCHED: Final = tuple(_mistake(entry) for entry in table())
"""The mistakes of the table."""
