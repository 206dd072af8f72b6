"""The committed studies made again: ``python -m validation.make.study_reports [NAME...]``.

Each is run from its beginning in a temporary folder, packed, and reported from what was packed, so
that the numbers of the committed summary are those of the committed rows. ``--report`` runs
nothing: it judges the claims of the rows that are there again, by today's files of options, and
reports them. Of the report, the figures and the sections that pages show are kept; whoever wants
all of it writes it from the rows, by ``quasistatic-ref study report validation/studies/NAME``.
"""

import sys
import tempfile
import time

from quasistatic_ref.cli.main import main as command
from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.folders import CONTACT_QP, problem_set_folder
from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.page.parts import Report, Section
from quasistatic_ref.lab.study.measuring.judged_again import judged_again, write_packed
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.lab.study.report.report import study_report
from quasistatic_ref.lab.study.store.store import contents
from validation.tools.scripts import ROOT, script_options

FOLDER = ROOT / "validation" / "studies"
NAMES = ("default", "sequences")
SHOWN = {
    "Who solves what": slice(-2),  # without the lines of pandas
    "Every interface": slice(None),
    "By problem family": slice(1),  # the setting that pages show
    "Steps in order": slice(None),
}
"""Sections that are kept, and which of their blocks."""


def summary(report: Report) -> str:
    """The page of what is kept of a report."""
    shown = (s for s in report.sections if s.title in SHOWN)
    sections = (Section(s.title, s.blocks[SHOWN[s.title]]) for s in shown)
    return markdown_page(Report(report.title, tuple(sections)))


def make(name: str, run: bool) -> None:
    """Run and pack one study, or judge the claims of its rows again; report it."""
    out = str(FOLDER / name)
    with tempfile.TemporaryDirectory() as store:
        begun = time.perf_counter()
        if not run:
            found = contents(out, every=True)
            ids = [one["id"] for one in found.problems]
            problems = set_read(problem_set_folder(CONTACT_QP), ids=ids)
            write_packed(judged_again(found, problems), FOLDER / name)
        steps = [["run", name, "--out", store], ["pack", store, "--out", out]] if run else []
        for step in (*steps, ["report", out, "--out", out]):
            if command(["study", *step]):
                sys.exit(f"study {step[0]} of {name} failed")
            print(f"{name}: {step[0]} ended after {time.perf_counter() - begun:.0f} s")
    text_written(FOLDER / name / "summary.md", summary(study_report(out)))
    for page in ("report.html", "report.md"):
        (FOLDER / name / page).unlink()


if __name__ == "__main__":
    options = script_options(__doc__, NAMES, report=False)
    for name in options.names or NAMES:
        make(name, not options.report)
