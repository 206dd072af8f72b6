"""Each extra alone does what its name says.

Run ``python -m validation.tools.check_installs [EXTRA ...]``.

Builds the wheel. For each extra (``base`` is none) makes a fresh environment, installs the wheel
with that extra and nothing else, and runs the commands that ``COMMANDS`` gives it, in an empty
folder; those that start with ``checkout:`` run in the checkout, whose programs or pages they are.
Each must end with status 0, and write only where its line or its ``--help`` says. What the extra
does not bring must be refused by one sentence that names the extra that does (``REFUSED``). Then
the extra ``test`` is added, and the tests that need an extra run: those of this one must not be
skipped. The README's own lines are taken from the README.

``--python`` names another interpreter, ``--lowest`` installs the lowest versions that are declared,
``--out`` writes the table and keeps what other runs wrote there. The base comes by pip, as the
README says; with an extra or on another interpreter, uv takes the same wheels in less time, and it
can take the lowest. An environment takes one or two gigabytes and is removed. Exit status 1 if a
command fails.
"""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable
from dataclasses import dataclass
from importlib.metadata import distributions
from pathlib import Path

from validation.tools.installs import (
    ACTIONS,
    CHECKOUT,
    COMMANDS,
    MARKED,
    REFUSED,
    WALK_FILES,
)
from validation.tools.scripts import ROOT, environment, script_options

HEAD = (
    "| extra | Python | versions | MB | largest parts [MB] | install [s] | commands [s] | commands "
    "| verdict |"
)
LOWEST = ("--resolution", "lowest-direct", "--only-binary", ":all:")
"""Options of uv: of what the package itself asks for, the lowest versions; of the rest, newest."""
PARTS = 8
"""Packages that are named for their size."""
PAGE = """# What an installation holds, and that it works

Written by `python -m validation.tools.check_installs --out validation/results/installs.md`. Each
line is a fresh environment that holds the wheel with one extra (`base`: none), its size that of the
whole environment, pip included. The commands are those of `validation/tools/installs.py` when the
line was written; the times are those of one machine with 2 cores that were busy otherwise. What has
no line was not tried.

"""


@dataclass(frozen=True)
class Environment:
    """A virtual environment, and the empty folder that its commands run in."""

    home: Path
    folder: Path

    def run(self, line: str) -> subprocess.CompletedProcess[str]:
        """One command with this environment's programs and none of the checkout's modules."""
        place, line = (ROOT, line.removeprefix(CHECKOUT)) if CHECKOUT in line else ("", line)
        path = f"{self.home / 'bin'}{os.pathsep}{os.environ['PATH']}"
        settings = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PYTHONHOME")}
        settings |= {"PATH": path}
        words = shlex.split(line.replace("{out}", str(self.folder)))
        words[0] = str(self.home / "bin" / words[0])
        return subprocess.run(
            words, cwd=place or self.folder, env=settings, capture_output=True, text=True,
            stdin=subprocess.DEVNULL,
        )  # fmt: skip


def built_wheel(folder: Path) -> Path:
    """The wheel of this checkout."""
    command = [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", folder, ROOT]
    subprocess.run([str(word) for word in command], check=True, cwd=folder)
    (wheel,) = folder.glob("*.whl")
    return wheel


def environment_with(
    wheel: Path, extra: str, python: str, lowest: bool, folder: Path
) -> Environment:
    """A fresh environment with the wheel and an extra."""
    home = folder / "environment"
    empty = folder / "empty"
    empty.mkdir()
    if extra == "base" and python == sys.executable and not lowest:
        environment(home, str(wheel))
        return Environment(home, empty)
    own = environment(home, python=python)
    uv = environment(wheel.parent / "uv", "uv").with_name("uv")
    what = str(wheel) if extra == "base" else f"{wheel}[{extra}]"
    command = [uv, "pip", "install", "-q", "--python", own, "--compile-bytecode", what]
    if lowest:  # what a wheel asks for is direct only where pyproject.toml asks for it, too
        command += [*LOWEST, "-r", ROOT / "pyproject.toml"]
        command += [] if extra == "base" else ["--extra", extra]
    subprocess.run([str(word) for word in command], check=True)
    return Environment(home, empty)


def mebibytes(files: Iterable[Path]) -> float:
    """What files take on the disk; one with two names counts once."""
    found = (path.lstat() for path in files if path.is_symlink() or path.exists())
    return sum({(s.st_dev, s.st_ino): 512 * s.st_blocks for s in found}.values()) / 2**20


def largest(home: Path) -> str:
    """The largest packages of an environment, by the files that each one's record lists."""
    (packages,) = home.glob("lib/python*/site-packages")
    sizes = {
        package.name: mebibytes(Path(str(package.locate_file(file))) for file in package.files)
        for package in distributions(path=[str(packages)])
        if package.files is not None
    }
    named = sorted(sizes.items(), key=lambda item: -item[1])[:PARTS]
    return ", ".join(f"{name} {size:.0f}" for name, size in named)


def readme_code() -> str:
    """The example of README."""
    text = (ROOT / "README.md").read_text("utf-8")
    (block,) = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    return str(block)


def faults(at: Environment, extra: str) -> list[str]:
    """What is wrong with the commands of an extra, each printed as it runs."""
    for name, text in {"readme.py": readme_code(), **WALK_FILES}.items():
        (at.folder / name).write_text(text, "utf-8")
    wrong = []
    for line in COMMANDS[extra]:
        start = time.perf_counter()
        there = {path.name for path in at.folder.iterdir()}
        done = at.run(line)
        fault = f"status {done.returncode}\n{done.stdout}{done.stderr}" if done.returncode else ""
        made = {path.name for path in at.folder.iterdir()} - there
        allowed = places(at, line)
        if unasked := {name for name in made if not {name, Path(name).stem} & allowed}:
            fault += f"writes {sorted(unasked)}, which neither the line nor its help names"
        if not fault and line.startswith("quasistatic-ref run") and "--json" in line:
            report = json.loads(done.stdout)
            if report["certified"] != f"{report['steps']} of {report['steps']} steps exact":
                fault = report["certified"]
        print(f"  {time.perf_counter() - start:6.1f} s  {line}", flush=True)
        if fault:
            wrong.append(f"{line}: {fault}")
            print(fault, flush=True)
    for line, names in REFUSED.get(extra, {}).items():
        done = at.run(line)
        print(f"  refused: {line}: {done.stderr.strip().splitlines()[-1:]}", flush=True)
        traced = "Traceback" in done.stderr and not line.startswith("python")
        if names not in done.stderr or traced:
            wrong.append(f"{line}: does not name {names}: {done.stderr}")
    return wrong


def places(at: Environment, line: str) -> set[str]:
    """The names in the empty folder, with or without their suffix, that a command may make.

    They are those of its line, of its help, and of the text of a script that the line runs.
    """
    words = shlex.split(line)
    said = " ".join(words)
    if words[0] == "quasistatic-ref":
        action = [word for word in words[2:4] if word in ACTIONS]
        said += "\n" + at.run(shlex.join([*words[:2], *action, "--help"])).stdout
    for script in {at.folder / word for word in words if word.endswith(".py")}:
        if script.is_file():
            said += "\n" + script.read_text("utf-8")
    return {part for word in re.findall(r"[\w./-]+", said) for part in Path(word).parts}


def failed_or_skipped(at: Environment, wheel: Path, extra: str) -> list[str]:
    """With `test` beside the extra: the tests of the extra that fail, or that are skipped."""
    uv = wheel.parent / "uv" / "bin" / "uv"
    python = at.home / "bin" / "python"
    command = [uv, "pip", "install", "-q", "--python", python, f"{wheel}[{extra},test]"]
    subprocess.run([str(word) for word in command], check=True)
    done = at.run("checkout:python -m pytest -q -p no:cacheprovider -m extra -n 2")
    print(done.stdout[-2000:], flush=True)
    wrong = [line for line in done.stdout.splitlines() if f"needs the extra {extra}:" in line]
    return wrong + ([f"pytest ended with status {done.returncode}"] if done.returncode else [])


def row(wheel: Path, extra: str, python: str, lowest: bool) -> tuple[list[str], list[str]]:
    """The cells of a line of the table, and what was wrong."""
    folder = Path(tempfile.mkdtemp(prefix="installs-"))
    try:
        start = time.perf_counter()
        at = environment_with(wheel, extra, python, lowest, folder)
        took = time.perf_counter() - start
        size = mebibytes(at.home.rglob("*"))
        parts = largest(at.home)
        version = at.run("python -V").stdout.removeprefix("Python ").strip()
        print(f"{extra}, Python {version}: {size:.0f} MB in {took:.0f} s", flush=True)
        start = time.perf_counter()
        wrong = faults(at, extra)
        if extra in MARKED:
            wrong += failed_or_skipped(at, wheel, extra)
        ran = time.perf_counter() - start
    except subprocess.CalledProcessError as error:
        return [extra, python, _versions(lowest), *"-----", "cannot be installed"], [str(error)]
    finally:
        shutil.rmtree(folder)
    count = len(COMMANDS[extra]) + len(REFUSED.get(extra, {}))
    verdict = f"{len(wrong)} fail" if wrong else "good"
    cells = [extra, version, _versions(lowest), f"{size:.0f}", parts]
    return [*cells, f"{took:.0f}", f"{ran:.0f}", str(count), verdict], wrong


def _versions(lowest: bool) -> str:
    return "lowest" if lowest else "newest"


def write_table(path: Path, rows: list[list[str]]) -> None:
    """The table with these rows; other rows of a table that is there stay."""
    kept = {}
    for line in path.read_text("utf-8").splitlines() if path.exists() else []:
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("|") and line != HEAD and cells[0] in COMMANDS:
            kept[tuple(cells[:3])] = cells
    kept |= {tuple(cells[:3]): cells for cells in rows}
    order = list(COMMANDS)
    found = sorted(
        kept.values(), key=lambda cells: (order.index(cells[0]), cells[2] != "newest", cells[1])
    )
    lines = [HEAD, "|" + "---|" * (HEAD.count("|") - 1)]
    lines += ["| " + " | ".join(cells) + " |" for cells in found]
    path.write_text(PAGE + "\n".join(lines) + "\n", "utf-8")


def main() -> int:
    """Try what was named; 1 if something is wrong."""
    options = script_options(__doc__, COMMANDS, python=sys.executable, lowest=False, out=Path)
    wrong = []
    with tempfile.TemporaryDirectory() as temporary:
        wheel = built_wheel(Path(temporary))
        for extra in options.names or COMMANDS:
            cells, faulty = row(wheel, extra, options.python, options.lowest)
            print("| " + " | ".join(cells) + " |", flush=True)
            if options.out is not None:
                write_table(options.out, [cells])
            wrong += [f"{extra}: {fault}" for fault in faulty]
    print("\n".join(wrong), file=sys.stderr, end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
