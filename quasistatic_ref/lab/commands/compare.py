"""``compare SCENE RUN``: where another program's run leaves the reference, and why."""

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.cli import options as shared
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.oracle.comparison import DIGITS, Comparison, comparison_of_run
from quasistatic_ref.lab.oracle.run_table import other_run
from quasistatic_ref.scenario.scenario import Scenario, load_scenario

SHOWN = 4
"""Causes that are printed at most."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    scene = parser.add_argument("scene", help="a TOML file, or the name of an installed scenario")
    shared.completed(scene, scenario_names, ".toml")
    words = "the run: a table in CSV, with a column t and one for each entry of q; or an .npz file"
    shared.completed(parser.add_argument("run", type=Path, help=words), tuple, ".csv", ".npz")
    words = f"correct digits of a step that counts as right (default: {DIGITS:g})"
    parser.add_argument("--digits", type=float, default=DIGITS, metavar="D", help=words)
    shared.add(parser, *shared.SOLVER, "--law", "--set", "--root", "--json")


def run(options: argparse.Namespace) -> int:
    """Compare; 1 if a step is another."""
    scenario = load_scenario(options.scene, shared.scenario_settings(options))
    read = other_run(options.run, scenario)
    found = comparison_of_run(
        scenario, read, options.digits, lambda line: shared.progress_line(options, f"{line} ...")
    )
    if options.json:
        shared.print_json(record(found, scenario))
    else:
        for line in sentences(found, scenario):
            shared.print_wrapped(line)
    return int(found.first is not None or bool(found.failed))


def record(found: Comparison, scenario: Scenario) -> dict[str, Any]:
    """A comparison as plain data."""
    first = None
    if found.first is not None:
        off = found.first.off
        first = {"step": found.first.k, "t": found.first.k * scenario.h,
                 "digits": found.first.digits, "coordinate": _largest(found, scenario),
                 "off": float(off[np.abs(off).argmax()]), "contact": found.contact or None,
                 "layers": list(found.layers),
                 "causes": [{"layer": c.layer, "name": c.name, "sentence": c.sentence}
                            for c in found.causes]}  # fmt: skip
    return {"steps": found.steps, "digits": found.digits, "resolution": found.resolution,
            "first": first, "failed": found.failed or None}  # fmt: skip


def _largest(found: Comparison, scenario: Scenario) -> str:
    assert found.first is not None
    return scenario.system.coordinates[int(np.abs(found.first.off).argmax())].name


def sentences(found: Comparison, scenario: Scenario) -> list[str]:
    """A comparison in words."""
    lines = []
    if found.resolution:
        lines.append(f"the numbers of the run are rounded to {found.resolution:.1g}")
    first = found.first
    if first is None:
        lines.append(
            f"{found.steps} steps, each as the reference takes it, to {found.digits:.1f} digits"
        )
    else:
        off = first.off[np.abs(first.off).argmax()]
        name = _largest(found, scenario)
        unit = scenario.system.coordinates[int(np.abs(first.off).argmax())].unit
        lines.append(
            f"step {first.k} (t = {first.k * scenario.h:g} s) is the first that is another: "
            f"{first.digits:.1f} digits, {name} is off by {off:.3g} {unit}; "
            f"{found.steps} steps were compared"
        )
        layers = " or ".join(found.layers)
        at = f", contact {found.contact}" if found.contact else ""
        lines.append(f"layer {layers}{at}")
        for cause in found.causes[:SHOWN]:
            head = f"looks like {cause.name}: " if cause.name else f"{cause.layer}: "
            lines.append(head + cause.sentence)
        if len(found.causes) > SHOWN:
            lines.append(f"{len(found.causes) - SHOWN} other changes of a line do the same")
        if not found.causes:
            lines.append("none of the mistakes that are tried ends its steps as they end")
    if found.failed:
        lines.append(f"the reference takes no further step: {found.failed}")
    return lines
