"""Whether the verdict of bunny_grasp depends on numbers that the paper does not give.

Run ``python -m validation.make.grasp_verdict``. The verdict: during the lift the bunny turns less
than 1 degree with torsion and more than 30 without, all else being equal, each step having 13
variables and 80 rows. First over mass and time step, and over the start of the sampling and time
step, where it must hold (exit status 1 if it does not); then over numbers that are pushed until it
breaks.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from quasistatic_ref.errors import RunFailed
from quasistatic_ref.formats.resources import models_folder
from quasistatic_ref.lab.grasp import CASES, TOP, grasp_report
from quasistatic_ref.scenario.scenario import load_scenario

BODIES = ((0.1, 0), (0.2, 0), (0.25, 0), (0.2, 600), (0.2, 1200))
"""Mass [kg] and start of the sampling."""
BEYOND = ((0.1, 600), (0.1, 1200), (0.3, 0), (0.4, 0))
"""Bodies for which it may break."""
TIME_STEPS = (0.005, 0.01, 0.02)
TURNS_NOT, TURNS = 1.0, 30.0
"""[deg]"""
HOLDS = "holds"
PUSHED = {
    "mu_omega [m] (0.003)": [f"contacts.grip.mu_omega={x}" for x in (0.004, 0.002, 0.0018, 0.0015)],
    "width stiffness [N/m] (1000)": [
        f"bodies.gripper.K_q.width={x}" for x in (4000, 2000, 500, 250)
    ],
    "mu_v of the grip (0.6)": [f"contacts.grip.mu_v={x}" for x in (0.8, 0.5, 0.4, 0.3)],
    "points per finger (5)": [f"contacts.grip.k={x}" for x in (1, 2, 10)],
}


def folder_with(mass: float, start: int, folder: Path) -> Path:
    """Scenario file of a bunny of another mass or another cloud."""
    source = models_folder() / "bunny_grasp"
    for name in ("bunny_grasp.toml", "gripper.urdf"):
        shutil.copy(source / name, folder)
    options = ["--mass", str(mass), "--start", str(start), "--out", str(folder)]
    subprocess.run([sys.executable, str(source / "build.py"), *options], check=True)
    return folder / "bunny_grasp.toml"


def verdict(scenario: Path, settings: list[str], h: float = 0.01) -> tuple[str, str, str]:
    """Rotation with and without torsion [deg], and whether the verdict holds."""
    rotations, sizes = [], set()
    for own in CASES.values():
        lift = [f"h={h}", f"steps={round(TOP / h)}"]
        # The case comes last, so that mu_omega = 0 is not overruled.
        try:
            loaded = load_scenario(scenario, [*lift, *settings, *own], fast=True)
            report = grasp_report(loaded, loaded.run(progress=False))
        except RunFailed as failure:
            return ("-", "-", f"not solved: {failure.reason}")
        rotations.append(float(str(report["rotation_deg"])))
        sizes.add((report["variables"], report["rows"]))
    holds = rotations[0] < TURNS_NOT < TURNS < rotations[1]
    said = HOLDS if holds else "breaks"
    if sizes != {(13, 80)}:
        said += f", size {sorted(sizes)}"
    return (f"{rotations[0]:.3f}", f"{rotations[1]:.1f}", said)


def table(bodies: tuple[tuple[float, int], ...]) -> int:
    """Print a row for each body and time step; how many do not hold."""
    broken = 0
    for mass, start in bodies:
        with tempfile.TemporaryDirectory() as temporary:
            scenario = folder_with(mass, start, Path(temporary))
            for h in TIME_STEPS:
                torsion, none, said = verdict(scenario, [], h)
                broken += said != HOLDS
                row = f"{mass:9g}  {1e3 * h:6g}  {start:5d}  {torsion:>11}  {none:>13}  {said}"
                print(row, flush=True)
    return broken


def main() -> int:
    """Print the tables."""
    print("mass [kg]  h [ms]  start   with [deg]  without [deg]")
    broken = table(BODIES)
    print("\nbodies for which it may break")
    table(BEYOND)
    print("\npushed, one number at a time (0.2 kg, 10 ms, start 0)")
    for title, settings in PUSHED.items():
        for setting in settings:
            torsion, none, said = verdict(
                models_folder() / "bunny_grasp/bunny_grasp.toml", [setting]
            )
            value = setting.split("=")[1]
            print(f"{title:30} {value:>6}  {torsion:>9}  {none:>7}  {said}", flush=True)
    return int(broken > 0)


if __name__ == "__main__":
    sys.exit(main())
