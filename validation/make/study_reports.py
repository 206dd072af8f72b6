"""The committed studies made again: ``python -m validation.make.study_reports [NAME...]``.

Each is run from its beginning in a temporary folder, packed, and reported from what was packed, so
that the numbers of the committed summary are those of the committed rows. ``--report`` runs
nothing: it judges the claims of the rows that are there again, by today's files of options, and
reports them. Of the report, the figures and the sections that pages show are kept; whoever wants
all of it writes it from the rows, by ``quasistatic-ref study report validation/studies/NAME``.

``bunny_torsion`` compares no solvers. It is the grasp with other values, run as by ``run --sweep``,
but for 3 s whatever h is.
"""

import sys
import tempfile
import time

from quasistatic_ref.cli.main import main as command
from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.folders import CONTACT_QP_2, problem_set_folder
from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.page.parts import Report, Section
from quasistatic_ref.lab.study.measuring.judged_again import judged_again, write_packed
from quasistatic_ref.lab.study.measuring.sweep import Axis, Sweep, run_sweep
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.lab.study.report.report import study_report
from quasistatic_ref.lab.study.store.store import contents
from validation.tools.scripts import ROOT, script_options

FOLDER = ROOT / "validation" / "studies"
GRIP = "bunny_torsion"
NAMES = ("default", "sequences", GRIP)
K = ("contacts.grip.k", "contacts.floor.k")
AXES = {
    "mu_omega and h": (
        Axis(
            "mu_omega", ("contacts.grip.mu_omega",), (0.0, 0.001, 0.002, 0.003, 0.005, 0.01, 0.02)
        ),
        Axis("h", ("h",), (0.04, 0.02, 0.01)),
    ),
    "stiffness of the grip": (
        Axis("K_width", ("bodies.gripper.K_q.width",), (250, 500, 1000, 2000)),
    ),
    "closest points": (Axis("k", K, (1, 2, 5, 10)),),
    "cone": (Axis("cone", ("cone",), ("pyramid", "facets-8", "product")),),
}
SHOWN = {
    "Who solves what": slice(-2),  # without the lines of pandas
    "Every interface": slice(None),
    "By problem family": slice(1),  # the setting that pages show
    "Steps in order": slice(None),
} | dict.fromkeys(AXES, slice(None))
"""Sections that are kept, and which of their blocks."""
SWEEPS = [Sweep(name, "bunny_grasp", 3.0, axes) for name, axes in AXES.items()]


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
        if run and name == GRIP:
            run_sweep(SWEEPS, store)
        if not run and name != GRIP:
            found = contents(out, every=True)
            ids = [one["id"] for one in found.problems]
            problems = set_read(problem_set_folder(CONTACT_QP_2), ids=ids)
            write_packed(judged_again(found, problems), FOLDER / name)
        steps = [] if name == GRIP else [["run", name, "--out", store]]
        steps.append(["pack", store, "--out", out])
        for step in (*(steps if run else []), ["report", out, "--out", out]):
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
