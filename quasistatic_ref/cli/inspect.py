"""``inspect URDF|SCENARIO``: coordinates in order, shapes, masses, and what the model ignores."""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.cli import options as shared
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.simulate.scenario import Scenario, load_scenario
from quasistatic_ref.step.cones import cone

IGNORED = (
    "velocities and accelerations: nothing moves on by itself",
    "joint limits, effort and velocity limits, damping and friction in the URDF",
    "visual geometry, and contacts between bodies that no pair names",
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument(
        "file", help="a URDF, a scenario (TOML), or the name of a scenario that comes along"
    )
    shared.add_set(parser)
    shared.add_json(parser)


def run(options: argparse.Namespace) -> int:
    """Print what there is."""
    if Path(options.file).suffix.lower() in (".urdf", ".xml"):
        path = Path(options.file)
        name = re.sub(r"[/#*\s]", "_", path.stem).replace("world", "world_") or "robot"
        record = system_record(System([Body(name=name, urdf=path)]))
    else:
        record = scenario_record(load_scenario(options.file, options.settings))
    if options.json:
        shared.print_json(record)
    else:
        _print(record)
    return 0


def system_record(system: System) -> dict[str, Any]:
    """What a system holds, as plain data."""
    return {
        "coordinates": [
            {"name": c.name, "unit": c.unit, "actuated": c.actuated} for c in system.coordinates
        ],
        "n_a": system.n_a,
        "n_u": system.n_u,
        "links": [
            {
                "name": link,
                "mass": float(system.masses[i]),
                "shapes": [
                    {"name": s.name, "kind": type(s.shape).__name__}
                    for s in system.shapes
                    if s.link == i
                ],
            }
            for i, link in enumerate(system.links)
            if i > 0
        ],
        "ignored": [*IGNORED, *system.ignored],
    }


def scenario_record(scenario: Scenario) -> dict[str, Any]:
    """What a scenario holds, as plain data."""
    record = system_record(scenario.system)
    for i, coordinate in enumerate(record["coordinates"]):
        if coordinate["actuated"]:
            coordinate["K_q"] = scenario.K_q[i, i]
    record |= {"h": scenario.h, "steps": scenario.steps, "backend": scenario.backend}
    record["cone"] = scenario.cone
    record["pairs"] = [_pair(pair, scenario.cone) for pair in scenario.pairs]
    record["size"] = [scenario.system.n_v, sum(p["contacts"] * p["rows"] for p in record["pairs"])]
    return record


def _pair(pair: ContactPair, name: str) -> dict[str, Any]:
    return {
        "name": pair.name,
        "alpha": type(pair.alpha.shape).__name__,
        "beta": type(pair.beta.shape).__name__,
        "mu_v": pair.mu_v,
        "mu_omega": pair.mu_omega,
        "contacts": pair.n_c,
        "rows": int(cone(name).counts(np.array([pair.rows]))[0]),
    }


def _print(record: dict[str, Any]) -> None:
    print(f"q = [q_a; q_u]: {record['n_a']} actuated, {record['n_u']} un-actuated coordinates")
    rows: list[tuple[str, ...]] = [("coordinate", "unit", "actuated", "K_q")]
    for c in record["coordinates"]:
        stiffness = f"{c['K_q']:g} {'N/m' if c['unit'] == 'm' else 'N m/rad'}" if "K_q" in c else ""
        rows.append((c["name"], c["unit"], "yes" if c["actuated"] else "no", stiffness))
    shared.print_rows(rows)
    print()
    rows = [("link", "mass [kg]", "collision shapes")]
    for link in record["links"]:
        kinds = ", ".join(shape["kind"] for shape in link["shapes"]) or "none"
        rows.append((link["name"], f"{link['mass']:g}", kinds))
    shared.print_rows(rows)
    if "pairs" in record:
        print()
        rows = [("pair", "shapes", "mu_v", "mu_omega [m]", "contacts", "rows each")]
        for p in record["pairs"]:
            shapes, numbers = (
                f"{p['alpha']} - {p['beta']}",
                (f"{p['mu_v']:g}", f"{p['mu_omega']:g}"),
            )
            rows.append((p["name"], shapes, *numbers, str(p["contacts"]), str(p["rows"])))
        shared.print_rows(rows)
        variables, constraints = record["size"]
        print(f"\neach step: {variables} variables, {constraints} rows; h = {record['h']:g} s")
    print("\nthe model ignores:")
    for sentence in record["ignored"]:
        print(f"- {sentence}")
