"""What is uploaded is whole: ``python -m validation.tools.check_sdist [TEST ...]``.

Builds the sdist, and the wheel from it, as ``python -m build`` does; build and twine are installed
into an environment of their own for that. Then these must hold:

- ``twine check --strict`` finds nothing;
- the sdist has every file that git knows in this checkout, and none that it does not know;
- the tests pass in the unpacked sdist, where any connection would fail: those that are named (files
  or folders of ``tests/``; ``tests`` is all of them), else ``TESTS``. They run with the interpreter
  that runs this, hence with its packages, and import the unpacked sdist.

Exit status 1 if one of them does not.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
TESTS = (
    *(f"tests/meta/test_{name}.py" for name in (
        "docstrings", "first_scene", "installs", "layers", "lock", "readme", "release", "sdist",
        "traceability", "workflows",
    )),
    "tests/equations", "tests/lab/study/test_committed_studies.py",
    "tests/lab/vectors/test_folder.py",
)  # fmt: skip
"""Those that read most of the checkout, not the package alone: docs, models, committed results."""
NOWHERE = "http://127.0.0.1:9"
"""A proxy where nobody listens."""
MADE = {"PKG-INFO"}
"""What an sdist has that nobody wrote."""


def members(sdist: Path) -> set[str]:
    """The files of an sdist, without the folder that holds them all."""
    with tarfile.open(sdist) as archive:
        return {member.name.partition("/")[2] for member in archive if not member.isdir()}


def tracked() -> set[str]:
    """The files of the checkout that git knows, and that are there."""
    said = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True)
    return {name for name in said.stdout.decode().split("\0") if name and (ROOT / name).exists()}


def built(folder: Path) -> list[str]:
    """Sdist and wheel in ``folder/dist``; what twine finds."""
    python = folder / "tools" / "bin" / "python"
    for command in (
        [sys.executable, "-m", "venv", folder / "tools"],
        [python, "-m", "pip", "install", "-q", "build", "twine"],
        [python, "-m", "build", "--outdir", folder / "dist", ROOT],
    ):
        subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)
    command = [str(python), "-m", "twine", "check", "--strict", *map(str, folder.glob("dist/*"))]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    print(done.stdout, end="", flush=True)
    return [f"twine: {done.stdout}{done.stderr}"] if done.returncode else []


def tested(sdist: Path, tests: list[str], folder: Path) -> list[str]:
    """What fails of the tests in an sdist that is unpacked into a folder."""
    with tarfile.open(sdist) as archive:
        # Python 3.11.2, of Debian 12, has no such filter yet; later ones warn without it.
        archive.extraction_filter = getattr(tarfile, "data_filter", None)
        archive.extractall(folder)
    (root,) = folder.iterdir()
    proxies = dict.fromkeys(("http_proxy", "https_proxy", "all_proxy"), NOWHERE)
    settings = os.environ | proxies | {"PYTHONPATH": str(root), "PIP_NO_INDEX": "1"}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *tests]
    done = subprocess.run(command, cwd=root, env=settings, check=False)
    return [f"tests fail in the sdist: {' '.join(tests)}"] if done.returncode else []


def main() -> int:
    """Build, compare, test; 1 if something is wrong."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("tests", nargs="*", metavar="TEST", help=f"default: {' '.join(TESTS)}")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="sdist-") as temporary:
        folder = Path(temporary)
        wrong = built(folder)
        (sdist,) = folder.glob("dist/*.tar.gz")
        files = members(sdist) - MADE
        wrong += [f"{name} is not in the sdist" for name in sorted(tracked() - files)]
        wrong += [f"{name} is in the sdist, not in git" for name in sorted(files - tracked())]
        wrong += tested(sdist, options.tests or list(TESTS), folder / "unpacked")
    print("\n".join(wrong), file=sys.stderr, end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
