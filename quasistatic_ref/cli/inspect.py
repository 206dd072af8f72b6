"""``inspect URDF|SCENARIO``: coordinates in order, shapes, masses, and what the model ignores."""

import argparse
import re
from collections.abc import Collection, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.cli import options as shared
from quasistatic_ref.cli.ignored import ignored_lines
from quasistatic_ref.cli.named_fields import field_lines, named_fields
from quasistatic_ref.contact.all_pairs import closest_points
from quasistatic_ref.contact.normals import SAYS, UNIQUE_NORMAL
from quasistatic_ref.contact.pairs import ContactPair, contact_layout
from quasistatic_ref.errors import ContactError
from quasistatic_ref.files.finding import finding_table
from quasistatic_ref.files.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.files.urdf.file import urdf_tree
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.parts import is_there
from quasistatic_ref.simulate.finding import severity
from quasistatic_ref.step.cones import cone

READ_AS = "a fixed base, all joints actuated"
"""How a URDF alone is read: robots are so, and inertias that no body can have are then accepted."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument(
        "file", help="a URDF, a scenario (TOML), or the name of an installed scenario"
    )
    shared.add(parser, "--set", "--root", "--json")


def run(options: argparse.Namespace) -> int:
    """Print the content of a URDF or a scenario."""
    if Path(options.file).suffix.lower() in (".urdf", ".xml"):
        path = Path(options.file)
        missing: list[str] = []
        tree = urdf_tree(path, options.roots, missing)
        body = Body(body_name(path), tree, actuated="all")
        record = {"read_as": READ_AS, "missing": missing, **system_record(System([body]))}
    else:
        record = scenario_record(load_scenario(options.file, shared.scenario_settings(options)))
    if options.json:
        shared.print_json(record)
    else:
        _print(record)
    return 0


def system_record(
    system: System, rubbed: Collection[str] = (), stopped: Collection[str] = ()
) -> dict[str, Any]:
    """What a system holds, as plain data; `rubbed` bodies have the friction of their files.

    `stopped` ones have the position limits of their files.
    """
    return {
        "coordinates": [
            {"name": c.name, "unit": c.unit, "actuated": c.actuated} for c in system.coordinates
        ],
        "positions": [p.heading for joint in system.joints for p in joint.positions],
        "mimics": [asdict(mimic) for mimic in system.mimics],
        "n_a": system.n_a,
        "n_u": system.n_u,
        "links": [
            {
                "name": link,
                "mass": float(system.masses[i]),
                "centre": system.centres[i].tolist(),
                "inertia": system.inertias[i].tolist(),
                "shapes": [
                    {"name": s.name, "kind": type(s.shape).__name__, "size": s.shape.words()}
                    for s in system.shapes
                    if s.link == i
                ],
            }
            for i, link in enumerate(system.links)
            if i > 0
        ],
        "ignored": ignored_lines(system, rubbed, stopped),
        "notes": list(system.notes),
    }


def body_name(path: Path) -> str:
    """The name of a URDF's body: the file's stem without characters that names must not have."""
    return re.sub(r"[/#*\s]", "_", path.stem).replace("world", "world_") or "robot"


def scenario_record(scenario: Scenario) -> dict[str, Any]:
    """What a scenario holds, as plain data."""
    of_urdf = ((), ()) if scenario.of_bodies is None else scenario.of_bodies.of_urdf
    record = system_record(scenario.system, *of_urdf)
    for i, coordinate in enumerate(record["coordinates"]):
        if coordinate["actuated"]:
            coordinate["K_q"] = scenario.K_q[i, i]
    record |= {"h": scenario.h, "steps": scenario.steps, "backend": scenario.backend}
    record |= {"fast": scenario.fast, "cone": scenario.cone}
    record["pairs"] = [_pair(pair, scenario.cone) for pair in scenario.pairs]
    record["size"] = [scenario.system.n_v, sum(p["contacts"] * p["rows"] for p in record["pairs"])]
    record["tied"] = tied_at_start(scenario)
    record |= {"findings": [], "not_looked_at": ""}
    if is_there("doctor"):
        from quasistatic_ref.optional.doctor import checks
        from quasistatic_ref.optional.doctor.frame.start import Start

        q = scenario.system.q_start
        force = None if scenario.force is None else scenario.force(0.0, q)
        start = Start(scenario.simulator(), q, force)
        findings, record["not_looked_at"] = checks.looked(checks.OF_SCENE, start)
        ignored = scenario.ignored_findings
        record["findings"] = [finding_table(one) for one in findings if one.name not in ignored]
    record["fields"] = named_fields(scenario.path)
    return record


def tied_at_start(scenario: Scenario) -> list[str]:
    """Sentences on the contacts that have several normals where the scenario starts."""
    system = scenario.system
    try:
        points = closest_points(scenario.pairs, system.kinematics(system.q_start))
    except ContactError as error:
        return [str(error)]
    names = contact_layout(scenario.pairs).contact_names(points.point)
    return [
        f"{name}: {SAYS[tie]}"
        for name, tie in zip(names, points.tie.tolist(), strict=True)
        if tie != UNIQUE_NORMAL
    ]


def _pair(pair: ContactPair, name: str) -> dict[str, Any]:
    return {
        "name": pair.name,
        "alpha": pair.alpha.shape.words(),
        "beta": pair.beta.shape.words(),
        "mu_v": pair.mu_v,
        "mu_omega": pair.mu_omega,
        "contacts": pair.n_c,
        "rows": int(cone(name).counts(np.array([pair.rows]))[0]),
    }


def _print(record: dict[str, Any]) -> None:
    if "read_as" in record:
        strict = "a scenario checks a free body more strictly"
        print(f"this URDF was read with {record['read_as']}; {strict}")
    missing = record.get("missing", [])
    _print_list("meshes that are not there, whose shapes are left out", missing)
    if missing:
        print()
    print(f"q = [q_a; q_u]: {record['n_a']} actuated, {record['n_u']} un-actuated coordinates")
    rows: list[tuple[str, ...]] = [("coordinate", "unit", "actuated", "K_q")]
    for c in record["coordinates"]:
        stiffness = f"{c['K_q']:g} {'N/m' if c['unit'] == 'm' else 'N m/rad'}" if "K_q" in c else ""
        rows.append((c["name"], c["unit"], "yes" if c["actuated"] else "no", stiffness))
    shared.print_rows(rows)
    shared.print_wrapped(f"entries of q: {', '.join(record['positions'])}")
    for m in record["mimics"]:
        print(f"{m['name']} = {m['multiplier']:g} * {m['of']} + {m['offset']:g}")
    print()
    print("inertias: about the centre of mass, along the link's axes")
    moments_of = "ixx iyy izz ixy ixz iyz [kg m^2]"
    rows = [("link", "mass [kg]", "centre of mass [m]", moments_of)]
    notes = []
    for link in record["links"]:
        inertia = np.array(link["inertia"])[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        moments = " ".join(f"{moment:.3g}" for moment in inertia) if link["mass"] else ""
        centre = " ".join(f"{x:.3g}" for x in link["centre"]) if link["mass"] else ""
        rows.append((link["name"], f"{link['mass']:g}", centre, moments))
        notes.append("; ".join(shape["size"] for shape in link["shapes"]) or "no collision shape")
    shared.print_rows(rows, notes)
    if "pairs" in record:
        print()
        rows = [("pair", "mu_v", "mu_omega [m]", "contacts", "rows each")]
        notes = []
        for p in record["pairs"]:
            numbers = (f"{p['mu_v']:g}", f"{p['mu_omega']:g}")
            rows.append((p["name"], *numbers, str(p["contacts"]), str(p["rows"])))
            notes.append(f"{p['alpha']} - {p['beta']}")
        shared.print_rows(rows, notes)
        variables, constraints = record["size"]
        print(f"\neach step: {variables} variables, {constraints} rows; h = {record['h']:g} s")
        print(f"solved by {record['backend']}")
    _print_list("normals that are one of several at the start", record.get("tied", []))
    findings = [
        f"{severity(one['grave'])}: {one['sentence']} [{one['name']}]"
        for one in record.get("findings", [])
    ]
    _print_list("findings, before a run", findings)
    if record.get("not_looked_at"):
        shared.print_wrapped(f"not looked at: {record['not_looked_at']}")
    _print_list("the model ignores", record["ignored"])
    if "fields" in record:
        print("\nfields of this scenario; --set NAME=VALUE changes one:")
        for line in field_lines(record["fields"]):
            print(f"  {line}")
    _print_list("the model differs from its files in", record["notes"])


def _print_list(heading: str, sentences: Sequence[str]) -> None:
    """Print a heading with sentences below it, unless there is no sentence."""
    if sentences:
        print(f"\n{heading}:")
    for sentence in sentences:
        shared.print_wrapped(sentence, "  ", "- ")
