"""The table of classic mistakes, mistakes.toml: each predicts what the patched program answers."""

import tomllib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Final

from quasistatic_ref.lab.vectors import check
from quasistatic_ref.lab.vectors.check.compare import parts
from quasistatic_ref.lab.vectors.check.mistake import Mistake, Prediction
from quasistatic_ref.lab.vectors.check.patched import program
from quasistatic_ref.lab.vectors.expected import Json

TABLE: Final = "mistakes.toml"
FACTOR: Final = "FACTOR"
"""In a patch, where a layer does not know h [s]: each of the values below, and its inverse."""
TIME_STEPS: Final = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)


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


@dataclass(frozen=True)
class Patch:
    """One way to make a mistake.

    Parameters
    ----------
    layers : list of str
        Those whose answers it changes.
    lines : str
        As :func:`~quasistatic_ref.lab.vectors.check.patched.patched_texts` has them.
    """

    layers: list[str]
    lines: str

    @property
    def variants(self) -> list[str]:
        """Its lines with each factor in the place of FACTOR."""
        if FACTOR not in self.lines:
            return [self.lines]
        return [self.lines.replace(FACTOR, repr(f)) for h in TIME_STEPS for f in (h, 1 / h)]


def _patch(text: str) -> Patch:
    head = text.partition("\n")[0]
    return Patch(head.partition(": ")[2].split(", "), text)


@dataclass(frozen=True)
class Entry:
    """One mistake of the table.

    Parameters
    ----------
    name, sentence : str
    patches : list of Patch
    """

    name: str
    sentence: str
    patches: list[Patch]

    @property
    def mistake(self) -> Mistake:
        """What it predicts, by layer."""
        layers = {layer for patch in self.patches for layer in patch.layers}
        return Mistake(self.name, self.sentence, {layer: self._in(layer) for layer in layers})

    def _in(self, layer: str) -> Prediction:
        mine = [patch for patch in self.patches if layer in patch.layers]
        return _predictions([lines for patch in mine for lines in patch.variants], layer)


def _table() -> tuple[Entry, ...]:
    text = (files(check) / TABLE).read_text(encoding="utf-8")
    return tuple(
        Entry(one["name"], one["sentence"], [_patch(p) for p in one["patches"].split("\n\n")])
        for one in tomllib.loads(text)["mistake"]
    )


ENTRIES: Final = _table()
"""The mistakes of mistakes.toml."""
