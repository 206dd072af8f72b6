"""``compare SCENE RUN ...``: where another program's runs leave the reference, and why."""

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.oracle.comparison import (
    DIGITS,
    Comparison,
    common_causes,
    comparison_of_run,
    diagnosis_of_runs,
)
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
    words = "further scenes and their runs, in turn"
    parser.add_argument("more", nargs="*", metavar="SCENE RUN", help=words)
    words = f"correct digits of a step that counts as right (default: {DIGITS:g})"
    parser.add_argument("--digits", type=float, default=DIGITS, metavar="D", help=words)
    shared.add(parser, *shared.SOLVER, "--law", "--set", "--root", "--json")


def run(options: argparse.Namespace) -> int:
    """Compare; 1 if a step is another.

    Raises
    ------
    InputError
        If a scene has no run.
    """
    if len(options.more) % 2:
        raise InputError("is a scene without a run", field="more", value=options.more[-1])
    settings = shared.scenario_settings(options)
    scenes = [options.scene, *options.more[::2]]
    found = []
    for scene, path in zip(scenes, [options.run, *options.more[1::2]], strict=True):
        shared.progress_line(options, f"comparing {path} ...")
        scenario = load_scenario(scene, settings)
        read = other_run(Path(path), scenario)
        found.append((scenario, comparison_of_run(scenario, read, options.digits)))
    every = [one for _, one in found]
    said = diagnosis_of_runs(every)
    common = common_causes(every)
    if options.json:
        runs = [record(one, scenario) for scenario, one in found]
        whole = {"runs": runs} if options.more else runs[0]
        layers = {one.layer for one in common}  # their steps are the run's: first of all they count
        if said is not None and not layers:
            layers = {said.layer}
        layer = layers.pop() if len(layers) == 1 else None  # mistakes of several layers may fit
        fields = {} if said is None else said._asdict()
        alike = {name: fields.get(name) for name in ("formulas", "place", "likeness")}
        shared.print_json(whole | {"layer": layer} | alike)
    else:
        for scene, (scenario, one) in zip(scenes, found, strict=True):
            head = f"{scene}: " if options.more else ""
            for line in sentences(one, scenario):
                shared.print_wrapped(head + line)
        if said is not None:
            shared.print_wrapped(
                f"layer {said.layer}: the planted mistake that is most alike (likeness "
                f"{said.likeness:.2f}) is in {' or in '.join(said.formulas)}, {said.place} of the "
                "plain program"
            )
        elif not common and any(one.wrong_parts for one in every):
            shared.print_wrapped("no planted mistake is like this: the layer is open")
    return int(any(one.is_wrong or one.failed for one in every))


def record(found: Comparison, scenario: Scenario) -> dict[str, Any]:
    """A comparison as plain data."""
    first = None
    if found.first is not None:
        off = found.first.off
        first = {"step": found.first.k, "t": found.first.k * scenario.h,
                 "digits": found.first.digits, "coordinate": _largest(found, scenario),
                 "off": float(off[np.abs(off).argmax()]), "contact": found.contact or None,
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
    if not found.steps and not found.failed:
        lines.append("the run has no step")
    elif first is None and found.steps:
        lines.append(
            f"{found.steps} steps, each as the reference takes it, to {found.digits:.1f} digits"
        )
    elif first is not None:
        off = first.off[np.abs(first.off).argmax()]
        name = _largest(found, scenario)
        unit = scenario.system.coordinates[int(np.abs(first.off).argmax())].unit
        lines.append(
            f"step {first.k} (t = {first.k * scenario.h:g} s) is the first that is another: "
            f"{first.digits:.1f} digits, {name} is off by {off:.3g} {unit}; "
            f"{found.steps} steps were compared"
        )
        if found.contact:
            lines.append(f"contact {found.contact} is off the most")
        for cause in found.causes[:SHOWN]:
            lines.append(f"looks like {cause.name} (layer {cause.layer}): {cause.sentence}")
        if not found.causes and not found.wrong_parts:
            lines.append("no classic mistake ends its steps as they end")
    if found.failed:
        lines.append(f"the reference takes no further step: {found.failed}")
    return lines
