"""What was right to the last bit stays so: ``python -m validation.make.same_bits``.

Compares hashes of certified runs with those that were written before: SHA-256 of q, delta_q, A'lam
and the slacks of every scenario, and of bunny_grasp without torsion too. A'lam and the slacks are
those of the exact optimum that the run's own multipliers lead to: lam itself is not unique. Runs
are taken with ``fast``; ``--set fast=false`` takes them on the plain path, ``--set
solver.backend=osqp`` with another backend, and the hashes are the same.

Takes twenty seconds. Exit status 1 if a run differs; its name is printed. ``--out FILE`` writes the
hashes, and compares nothing.
"""

import hashlib
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref import load_scenario
from quasistatic_ref.certify.exact import step_optimum
from quasistatic_ref.formats.resources import scenario_names
from validation.tools.scripts import RESULTS, record_written, script_options

RESULT = RESULTS / "same_bits.json"
WITHOUT_TORSION = "contacts.grip.mu_omega=0"


def sha256(*arrays: np.ndarray) -> str:
    """Of the bytes of some arrays."""
    return hashlib.sha256(b"".join(a.tobytes() for a in arrays)).hexdigest()


def run_record(name: str, settings: list[str]) -> dict[str, Any]:
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


def main() -> int:
    """Write hashes, or compare them; exit status 1 if a run differs."""
    options = script_options(__doc__, set=str, out=Path)
    settings = [options.set] if options.set else []
    found = {name: run_record(name, settings) for name in scenario_names()}
    bunny = run_record("bunny_grasp", [WITHOUT_TORSION, *settings])
    found[f"bunny_grasp {WITHOUT_TORSION}"] = bunny
    if options.out:
        record_written(options.out, found)
        return 0
    before = json.loads(RESULT.read_text("utf-8"))
    differ = [name for name in {**before, **found} if before.get(name) != found.get(name)]
    print(*[f"differs: {name}" for name in differ] or ["equal"], sep="\n")
    return int(bool(differ))


if __name__ == "__main__":
    sys.exit(main())
