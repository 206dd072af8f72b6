"""The ports of ``validation/ports``, built as they are or with other texts.

Run ``python -m validation.tools.ports FOLDER`` to build them there, to check what they answer to
the vectors and to challenge them with some new cases. Exit status 1 if anything is found.
"""

import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

from quasistatic_ref.lab.vectors.challenge.program import Program
from quasistatic_ref.lab.vectors.challenge.rounds import challenge
from quasistatic_ref.lab.vectors.check.folder import check_answers
from quasistatic_ref.lab.vectors.check.scope import scope_read
from validation.tools.scripts import ROOT

PORTS = ROOT / "validation" / "ports"
VECTORS = ROOT / "validation" / "vectors"
CASES = 88
"""That each is challenged with."""
BUILDS = {
    "go": ("go", "build", "-o", "{out}", "."),
    "cpp": ("g++", "-std=c++17", "-w", "-o", "{out}", "main.cpp", "-lgmpxx", "-lgmp"),
}
"""How each is compiled in its folder."""


def texts(name: str) -> dict[str, str]:
    """The files of a port."""
    return {path.name: path.read_text("utf-8") for path in sorted((PORTS / name).iterdir())}


def compiler_errors(name: str, out: Path, changed: Mapping[str, str] | None = None) -> str:
    """Compile a port, with files in the place of its own; what the compiler complains of.

    Parameters
    ----------
    name : str
    out : Path
        The program, there afterwards if nothing is complained of.
    changed : mapping, optional
        The text of each other file.
    """
    folder = out.with_name(f"{out.name}_source")
    folder.mkdir()
    for file, text in {**texts(name), **(changed or {})}.items():
        (folder / file).write_text(text, "utf-8")
    words = [word.format(out=out) for word in BUILDS[name]]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    shutil.rmtree(folder)
    return done.stderr if done.returncode else ""


def main() -> int:
    """Build, check and challenge both."""
    folder = Path(sys.argv[1])
    found = []
    for name in BUILDS:
        answers = folder / f"{name}_answers"
        answers.mkdir(parents=True)
        if said := compiler_errors(name, folder / name):
            raise SystemExit(said)
        subprocess.run([folder / name, VECTORS, answers], check=True)
        scope = scope_read(PORTS / name / "scope.toml")
        report = check_answers(answers, VECTORS, scope=scope)
        found += [] if report.ok else [f"{name}: {sentence}" for sentence in report.sentences]
        outcome = challenge(Program(str(folder / name)), cases=CASES, scope=scope)
        found += [f"{name}: {finding.title}" for finding in outcome.findings]
    print(*(found or ["both ports are right"]), sep="\n")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
