"""The inputs of the vectors, collected again: the steps of every scenario, after all other cases.

Run at a release. Cases of no scenario are written once, and stand in the files of inputs.
"""

from collections.abc import Callable
from pathlib import Path

from quasistatic_ref.formats.files import text_written, writable_folder
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.vectors.families.scenarios import scenario_cases
from quasistatic_ref.lab.vectors.files import Case, inputs_read, inputs_text
from quasistatic_ref.lab.vectors.layers import LAYERS


def harvested(source: Path, out: Path, say: Callable[[str], None]) -> dict[str, int]:
    """Write ``inputs/LAYER.json`` for every layer.

    Parameters
    ----------
    source : Path
        A folder of vectors, of which cases of scenarios are left out.
    out : Path
        May be the same.
    say : callable
        Called with a line on what is being done.

    Returns
    -------
    dict of str to int
        Number of cases of each layer.
    """
    writable_folder(out)
    scenarios = scenario_names()
    cases: dict[str, list[Case]] = {
        name: [case for case in inputs_read(source, name) if case.id.split("/")[1] not in scenarios]
        for name in LAYERS
    }
    for name, case in scenario_cases(say):
        cases[name].append(case)
    for name in LAYERS:
        text_written(out / "inputs" / f"{name}.json", inputs_text(name, cases[name]))
    return {name: len(found) for name, found in cases.items()}
