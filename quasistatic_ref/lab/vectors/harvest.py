"""The inputs of the vectors, collected: families written by rule, and steps of every scenario.

Run at a release. What it writes is committed, and everything else is computed from that.
"""

from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path

from quasistatic_ref.formats.files import text_written, writable_folder
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.scenarios import scenario_cases
from quasistatic_ref.lab.vectors.files import Case, inputs_text
from quasistatic_ref.lab.vectors.layers import LAYERS


def harvested(folder: Path, say: Callable[[str], None]) -> dict[str, int]:
    """Write ``inputs/LAYER.json`` for every layer.

    Parameters
    ----------
    folder : Path
    say : callable
        Called with a line on what is being done.

    Returns
    -------
    dict of str to int
        Number of cases of each layer.
    """
    writable_folder(folder)
    cases: dict[str, list[Case]] = {name: list(family(name)) for name in LAYERS}
    for name, case in scenario_cases(say):
        cases[name].append(case)
    for name in LAYERS:
        text_written(folder / "inputs" / f"{name}.json", inputs_text(name, cases[name]))
    return {name: len(found) for name, found in cases.items()}


def family(name: str) -> Iterator[Case]:
    """The cases of a layer that are written by rule."""
    module = import_module(f"{__package__}.families.{name}")
    found: Iterator[tuple[str, str, Json]] = getattr(module, f"{name}_cases")()
    return (Case(*case) for case in found)
