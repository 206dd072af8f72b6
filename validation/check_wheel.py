"""Build the wheel, install it in a fresh virtual environment, and try it in an empty folder.

Run from a checkout: ``python validation/check_wheel.py``. Exit status 1 if anything is missing.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parent.parent
DEMO_SECONDS = 60.0  # promised in the README, for both runs on 2 cores
DEMO_MEBIBYTES = 1024.0
VALIDATE_SECONDS = 300.0  # promised in the README, on 2 cores


def output(command: list[object], folder: Path) -> str:
    """Standard output of a command; its failure ends this script."""
    done = subprocess.run([str(c) for c in command], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{command} failed with status {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


def main() -> None:
    """Check what a user of the wheel would see first."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        output([sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", folder, ROOT], ROOT)
        (wheel,) = folder.glob("*.whl")
        output([sys.executable, "-m", "venv", folder / "venv"], folder)
        binary = folder / "venv" / "bin"
        output([binary / "pip", "install", "-q", f"{wheel}[engines,robots]"], folder)
        empty = folder / "empty"
        empty.mkdir()

        start = time.perf_counter()
        report = json.loads(output([binary / "quasistatic-ref", "demo", "--json"], empty))
        seconds = time.perf_counter() - start
        cases = report["cases"]
        print(f"demo: {seconds:.1f} s, {report['peak_mebibytes']:.0f} MiB")
        for case, numbers in cases.items():
            print(f"  {case}: rotation {numbers['rotation_deg']:.3f} deg")
        good = (
            cases["with torsion"]["rotation_deg"]
            < 2
            < 20
            < cases["without torsion"]["rotation_deg"]
            and seconds < DEMO_SECONDS
            and report["peak_mebibytes"] < DEMO_MEBIBYTES
            and all((empty / "demo" / name).stat().st_size > 0 for name in report["figures"])
        )
        start = time.perf_counter()
        claims = json.loads(output([binary / "quasistatic-ref", "validate", "--json"], empty))
        validated = time.perf_counter() - start
        print(f"validate: {validated:.1f} s")
        for claim in claims["claims"]:
            if claim["verdict"] != "holds":
                print(f"  {claim['name']}: {claim['verdict']}")
        good = good and validated < VALIDATE_SECONDS
        good = good and (empty / "validation" / "claims.md").stat().st_size > 0
        for scenario in sorted(path.stem for path in (ROOT / "models").glob("*/*.toml")):
            done = json.loads(
                output([binary / "quasistatic-ref", "run", scenario, "--json"], empty)
            )
            good = good and done["certified"] == f"{done['steps']} of {done['steps']} steps exact"
            print(f"run {scenario}: {done['certified']}")
        for command in (
            ["extract", "results/sphere_spin.npz", "--step", "150", "-o", "step.json"],
            ["solve", "step.json", "-o", "solution.json"],
            ["verify", "step.json", "solution.json"],
            ["inspect", "bunny_grasp"],
            ["backends"],
            ["vectors", "own", "--layer", "qp", "--out", "answers"],
            ["vectors", "check", "answers"],
        ):
            output([binary / "quasistatic-ref", *command], empty)
            print(f"{command[0]}: good")
        if not good:
            sys.exit("the demo or validate did not keep its promises")


if __name__ == "__main__":
    main()
