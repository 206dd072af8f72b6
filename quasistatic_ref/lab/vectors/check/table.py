"""The table of classic mistakes, mistakes.toml: each predicts what the patched program answers."""

import json
import tomllib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files

from quasistatic_ref.lab.vectors import check
from quasistatic_ref.lab.vectors.check.compare import parts
from quasistatic_ref.lab.vectors.check.patched import program
from quasistatic_ref.lab.vectors.expected import Json

TABLE = "mistakes.toml"
FACTOR = "FACTOR"
"""In a patch, where a layer does not know h [s]: each of the values below, and its inverse."""
TIME_STEPS = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)

Prediction = Callable[[Json, Json], Iterable[Json]]
"""(input, expected output) -> parts of outputs; several where the mistake comes in variants."""


@dataclass(frozen=True)
class Mistake:
    """One mistake.

    Parameters
    ----------
    name : str
    sentence : str
        What is wrong, and what is right.
    predictions : mapping
        By layer: what would be answered.
    """

    name: str
    sentence: str
    predictions: Mapping[str, Prediction]


@lru_cache(maxsize=32)
def _right_answer(layer: str, case: str) -> Json:
    """What the program answers without a patch."""
    return parts(program()(layer, json.loads(case)))


def _predictions(patches: list[str], layer: str) -> Prediction:
    """What each patch changes in the program's answer."""

    def predictions(case: Json, output: Json) -> Iterable[Json]:
        if not output.get("differentiable", True):
            return  # no number is right there
        right = _right_answer(layer, json.dumps(case))
        for patch in patches:
            try:
                wrong = parts(program(patch)(layer, case))
            except (ArithmeticError, LookupError, TypeError, ValueError):
                continue  # a mistake that cannot be made in this case
            yield {name: value for name, value in wrong.items() if value != right.get(name)}

    return predictions


def _at_kinks(kinds: list[str]) -> Prediction:
    """Any numbers where there is no derivative for a reason of one of these kinds."""

    def predictions(case: Json, output: Json) -> Iterable[Json]:
        if {reason["kind"] for reason in output["reasons"]} & set(kinds):
            yield {"differentiable": True}

    return predictions


def _variants(lines: str) -> list[str]:
    """A patch with each factor in the place of FACTOR."""
    if FACTOR not in lines:
        return [lines]
    return [lines.replace(FACTOR, repr(f)) for h in TIME_STEPS for f in (h, 1 / h)]


def _patches(entry: Json) -> dict[str, list[str]]:
    """The patches of an entry by the layers whose answers they change, as their heads say."""
    found: dict[str, list[str]] = {}
    for patch in entry["patches"].split("\n\n"):
        for layer in patch.partition("\n")[0].partition(": ")[2].split(", "):
            found.setdefault(layer, []).append(patch)
    return found


def _mistake(entry: Json) -> Mistake:
    name = entry["name"]
    by_layer = {
        layer: _predictions([one for patch in patches for one in _variants(patch)], layer)
        for layer, patches in PATCHES.get(name, {}).items()
    }
    if "kinks" in entry:
        by_layer["derivative"] = _at_kinks(entry["kinks"])
    return Mistake(name, entry["sentence"], by_layer)


_ENTRIES = tomllib.loads((files(check) / TABLE).read_text("utf-8"))["mistake"]
PATCHES = {entry["name"]: _patches(entry) for entry in _ENTRIES if "patches" in entry}
"""By mistake and layer: lines as ``patched_texts`` takes them, one or several ways."""
MISTAKES = tuple(map(_mistake, _ENTRIES))
"""Tried in this order; of equally good explanations all are named."""
