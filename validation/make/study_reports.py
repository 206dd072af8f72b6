"""The committed studies made again: ``python -m validation.make.study_reports [NAME...]``.

Each is run from its beginning in a temporary folder, packed, and reported from what was packed, so
that the numbers of the committed report are those of the committed rows. ``--report`` runs nothing,
and reports the rows that are there.
"""

import sys
import tempfile
import time

from quasistatic_ref.cli.main import main as command
from validation.tools.scripts import ROOT, asked

FOLDER = ROOT / "validation" / "studies"
NAMES = ("default", "sequences", "bunny_torsion")


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
    (FOLDER / name / "report.html").unlink()  # the same as Markdown and PNG; made at will


if __name__ == "__main__":
    options = asked(__doc__, NAMES, report=False)
    for name in options.names or NAMES:
        made(name, not options.report)
