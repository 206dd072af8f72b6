"""The committed studies made again: ``python -m validation.make.study_reports [NAME...]``.

Each is run from its beginning in a temporary folder, packed, and reported from what was packed, so
that the numbers of the committed report are those of the committed rows. Of the study of solvers
the sentences of docs/solver_study.md are made of them, too. ``--report`` runs nothing, and reports
the rows that are there.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

from quasistatic_ref.cli.main import main as command
from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.study.store.store import contents
from validation.make.study_advice import NAME as ADVICE
from validation.make.study_advice import advice

FOLDER = Path(__file__).parents[1] / "studies"
NAMES = ("default", "bunny_torsion")
REPORT = "--report"


def made(name: str, run: bool) -> None:
    """Run and pack one study, unless its rows are to stay; report it."""
    out = str(FOLDER / name)
    with tempfile.TemporaryDirectory() as store:
        begun = time.perf_counter()
        steps = [["run", name, "--out", store], ["pack", store, "--out", out]] if run else []
        for step in (*steps, ["report", out, "--out", out]):
            if command(["study", *step]):
                sys.exit(f"study {step[0]} of {name} failed")
            print(f"{name}: {step[0]} ended after {time.perf_counter() - begun:.0f} s")
    if name == "default":
        text_written(FOLDER / name / ADVICE, advice(contents(FOLDER / name)))
    for ending in ("html", "csv", "parquet"):  # the same as Markdown and PNG; made at will
        (FOLDER / name / f"report.{ending}").unlink(missing_ok=True)


if __name__ == "__main__":
    names = [word for word in sys.argv[1:] if word != REPORT]
    for name in names or NAMES:
        made(name, REPORT not in sys.argv)
