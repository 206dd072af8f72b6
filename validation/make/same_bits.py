"""What was right to the last bit stays so: ``python -m validation.make.same_bits --against FILE``.

Writes down what a change of the code must not change, and compares it with what was written before:

- ``runs``: SHA-256 of q, delta_q, A'lam and the slacks of every scenario, each step certified, and
  of bunny_grasp without torsion too. A'lam and the slacks are those of the exact optimum that the
  run's own multipliers lead to: lam itself is not unique. They are taken with ``fast``;
  ``--set fast=false`` takes them on the plain path, ``--set solver.backend=osqp`` with another
  backend, and the record is the same.
- ``vectors``: SHA-256 of each file that ``vectors generate`` writes in full.
- ``claims``: each quantity that ``validate`` measures, as its page shows it (six digits), but for
  times.

``--out FILE`` writes the record. Takes some three minutes; ``--parts runs`` ten seconds. Exit
status 1 if anything differs, which is printed.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from quasistatic_ref.certify.exact import step_optimum
from quasistatic_ref.formats.files import text_written
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.claims.claim import finding
from quasistatic_ref.lab.claims.registry import BY_NAME
from quasistatic_ref.lab.claims.report import finding_record
from quasistatic_ref.lab.folders import vectors_folder
from quasistatic_ref.lab.vectors.generate import generated
from quasistatic_ref.scenario.scenario import load_scenario

Record = dict[str, Any]
TIMES = ("step_time",)
"""Claims about times, which change from run to run."""

WITHOUT_TORSION = "contacts.grip.mu_omega=0"


def sha256(*arrays: np.ndarray) -> str:
    """Of the bytes of some arrays."""
    return hashlib.sha256(b"".join(a.tobytes() for a in arrays)).hexdigest()


def run_record(name: str, settings: list[str]) -> Record:
    """The hashes of one run, each step certified."""
    run = load_scenario(name, ["fast=true", "record=full", *settings]).run(progress=False)
    nets = []
    slacks = []
    for k in range(run.steps):
        optimum = step_optimum(run.step_data(k), np.flatnonzero(run["lam"][k] > 0).tolist())
        nets.append(optimum.net)
        slacks.append(optimum.slack)
    return {
        "steps": run.steps,
        "exact": int((run["certificate"] == "exact").sum()),
        "q": sha256(run["q"]),
        "delta_q": sha256(run["delta_q"]),
        "A'lam": sha256(*nets),
        "slack": sha256(*slacks),
    }


def runs(settings: list[str]) -> Record:
    """Every scenario that comes with the package, and the bunny without torsion."""
    found = {name: run_record(name, settings) for name in scenario_names()}
    bunny = run_record("bunny_grasp", [WITHOUT_TORSION, *settings])
    return found | {f"bunny_grasp {WITHOUT_TORSION}": bunny}


def vectors(settings: list[str]) -> Record:
    """Every file of the reference vectors, made from nothing."""
    with TemporaryDirectory() as folder:
        generated(vectors_folder(), Path(folder), progress=False)
        files = sorted(path for path in Path(folder).rglob("*") if path.is_file())
        return {
            path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in files
        }


def claims(settings: list[str]) -> Record:
    """Every quantity of every claim, measured and expected, to six digits."""
    found = {}
    for claim in BY_NAME.values():
        if claim.name in TIMES:
            continue
        record = finding_record(finding(claim))
        for c in record["comparisons"]:
            measured = "-" if c["measured"] is None else f"{c['measured']:.6g}"
            found[f"{claim.name}: {c['what']}"] = f"{measured} at {c['points']} points"
    return found


PARTS = {"runs": runs, "vectors": vectors, "claims": claims}


def differences(before: Record, now: Record, where: str = "") -> list[str]:
    """One line for each entry of two records that is not the same in both."""
    lines = []
    for key in {**before, **now}:
        one = before.get(key, "absent")
        two = now.get(key, "absent")
        if isinstance(one, dict) and isinstance(two, dict):
            lines += differences(one, two, f"{where}{key}: ")
        elif one != two:
            lines.append(f"{where}{key}: was {one}, is {two}")
    return lines


def main() -> int:
    """Make a record, keep it, compare it; exit status 1 if anything differs."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS))
    parser.add_argument("--out", type=Path, metavar="FILE", help="write the record here")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", dest="settings",
        help="change a field of every scenario of the runs",
    )  # fmt: skip
    parser.add_argument("--against", type=Path, metavar="FILE", help="compare with this record")
    options = parser.parse_args()
    record: Record = {}
    for part in options.parts:
        print(f"{part} ...", file=sys.stderr, flush=True)
        record[part] = PARTS[part](options.settings)
    if options.out:
        text_written(options.out, json.dumps(record, indent=1) + "\n")
    if options.against is None:
        return 0
    before = json.loads(options.against.read_text(encoding="utf-8"))
    found = differences(
        *({part: r.get(part, {}) for part in options.parts} for r in (before, record))
    )
    print("\n".join(found) or f"equal: {', '.join(options.parts)}")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
