"""What is optional can be taken away: ``python -m validation.tools.check_parts [PART ...]``.

Each named part (those of ``PARTS`` without a name) is deleted from a copy of the package, then all
of ``optional/``. The copy has no ``lab/`` either. ``quasistatic-ref run`` then takes the first
steps of the grasp, all arrays of which must have the bits that the whole package gives them; and a
word that needs the part must be refused in a sentence that names it.

Exit status 1 if one of them does not hold.
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from validation.tools.scripts import ROOT, script_options

SCENARIO = "bunny_grasp"
PARTS = {
    "coulomb": (["--law", "coulomb"], 'law = "coulomb"'),
    "curved": ([], ""),
    "derivatives": ([], ""),
    "doctor": (["--strict"], "strict"),
    "ellipsoid": (["--cone", "ellipsoid"], 'cone = "ellipsoid"'),
    "extensions": ([], ""),
    "fast": (["--fast"], "fast"),
    "forces": (["--set", "record=forces"], 'record = "forces"'),
    "guests": ([], ""),
    "qpsolvers": (["--backend", "qpsolvers:clarabel"], "qpsolvers:clarabel"),
    "readers": (["--set", "bodies.bunny.cloud=bunny.ply"], "a .ply cloud"),
    "scans": ([], ""),
    "scene_files": ([], ""),
    "show": (["--view"], "view"),
}
"""The parts, and of each the options of ``run`` that need it, and the word in the refusal."""


def package_copied(folder: Path, *without: str) -> Path:
    """A folder with the package as a wheel has it, but for ``lab/`` and some other folders."""
    package = folder / "quasistatic_ref"
    ignored = shutil.ignore_patterns("__pycache__", "lab")
    shutil.copytree(ROOT / "quasistatic_ref", package, ignore=ignored)
    for name in without:
        shutil.rmtree(package / name)
    shutil.copytree(ROOT / "models", package / "models")
    return folder


def run_of_package(
    folder: Path, out: Path, steps: int, *options: str
) -> subprocess.CompletedProcess[str]:
    """What ``quasistatic-ref run`` came to with the package in a folder, its run in `out`."""
    command = [sys.executable, "-m", "quasistatic_ref", "run", SCENARIO, "--set", f"steps={steps}"]
    return subprocess.run(
        [*command, "--out", str(out), *options],
        cwd=folder, capture_output=True, text=True, check=False,
    )  # fmt: skip


def arrays(folder: Path, steps: int) -> dict[str, bytes]:
    """The bits of all arrays of a run with the package in a folder.

    Raises
    ------
    RuntimeError
        If the run fails.
    """
    done = run_of_package(folder, folder, steps)
    if done.returncode:
        raise RuntimeError(done.stderr)
    with np.load(folder / f"{SCENARIO}.npz") as file:
        return {name: file[name].tobytes() for name in file.files if name != "header"}


def faults(expected: dict[str, bytes], steps: int, gone: str) -> list[str]:
    """What a package without a folder, or all of ``optional``, does wrong, one sentence each."""
    with tempfile.TemporaryDirectory() as made:
        folder = package_copied(Path(made), gone)
        try:
            found = arrays(folder, steps)
        except RuntimeError as error:
            return [f"the run fails: {error}"]
        wrong = [f"{name} has other bits" for name in expected if found.get(name) != expected[name]]
        for name, (options, word) in PARTS.items():
            if not options or gone not in ("optional", f"optional/{name}"):
                continue
            refused = run_of_package(folder, folder / "refused", 0, *options)
            sentence = f"{word} needs quasistatic_ref/{gone}"
            if refused.returncode != 2 or sentence not in refused.stderr:
                wrong.append(f"{word} is not refused in a sentence: {refused.stderr}")
        return wrong


def main() -> int:
    """Delete and compare; the exit status."""
    options = script_options(__doc__, PARTS, steps=40)
    with tempfile.TemporaryDirectory() as made:
        expected = arrays(package_copied(Path(made)), options.steps)
    status = 0
    for gone in [*(f"optional/{name}" for name in options.names or PARTS), "optional"]:
        wrong = faults(expected, options.steps, gone)
        print(f"without {gone}: {'; '.join(wrong) or 'the same bits'}", flush=True)
        status = status or int(bool(wrong))
    return status


if __name__ == "__main__":
    sys.exit(main())
