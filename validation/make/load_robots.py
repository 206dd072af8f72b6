"""Which robots of `example-robot-data` load with their collision shapes, and why the others do not.

    pip install example-robot-data
    python -m validation.make.load_robots

Every joint is actuated and the base is fixed: what a user of a robot arm does first. Prints a
Markdown table; exits with 1 if fewer than 64 of the 69 load.
"""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.model.system import Body, System

LOADED = 64
"""At least this many; the rest are refused by one sentence each."""


def robots_folder() -> Path:
    """Where the package keeps its robots: in some folder of Python's path, with its own prefix."""
    for place in map(Path, sys.path):
        found = place / "cmeel.prefix" / "share" / "example-robot-data" / "robots"
        if found.is_dir():
            return found
    sys.exit("example-robot-data is not installed; pip install example-robot-data")


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    """Nothing on standard error: urdfdom and assimp print there what the table says."""
    kept, null = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(null, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(null)


def row(path: Path, folder: Path) -> tuple[bool, str]:
    """One robot: whether it loads, and its line of the table."""
    start = time.perf_counter()
    body = Body("robot", path, actuated="all", package_dirs=(folder.parent.parent,))
    try:
        with quiet():
            system = System([body])
    except InputError as error:
        error.file = None
        sentence = str(error).replace(str(folder), "...")
        return False, f"| {path.relative_to(folder)} | refused | | {sentence} | |"
    kinds = Counter(type(placed.shape).__name__ for placed in system.shapes)
    shapes = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items())) or "none"
    hulled = sum("replaced by its convex hull" in note for note in system.notes)
    notes = f"{hulled} hulled, {sum('.inertial' in note for note in system.notes)} inertias noted"
    seconds = time.perf_counter() - start
    return True, (
        f"| {path.relative_to(folder)} | {system.n_v} | {shapes} | {notes} | {seconds:.1f} |"
    )


def main() -> int:
    """Print the table."""
    folder = robots_folder()
    rows = [row(path, folder) for path in sorted(folder.rglob("*.urdf"))]
    good = sum(loaded for loaded, _ in rows)
    print(f"{good} of {len(rows)} URDFs load with their collision shapes.\n")
    print("| URDF | coordinates | shapes | notes | s |\n|---|---|---|---|---|")
    print("\n".join(line for _, line in rows))
    return 0 if good >= LOADED else 1


if __name__ == "__main__":
    sys.exit(main())
