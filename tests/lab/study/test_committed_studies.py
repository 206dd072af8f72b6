"""The committed studies: each report is what the rows beside it give."""

from pathlib import Path

import pytest

from quasistatic_ref.formats.files import toml_read
from quasistatic_ref.lab.folders import CONTACT_QP_2, problem_set_folder
from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.study.file.study_file import solver_study, study_path
from quasistatic_ref.lab.study.problems.folder import manifest
from quasistatic_ref.lab.study.problems.selection import problems_taken
from quasistatic_ref.lab.study.report.report import study_report
from quasistatic_ref.lab.study.report.solver_report import solver_report

STUDIES = Path(__file__).parents[3] / "validation" / "studies"
DEFAULT = STUDIES / "default"
MOST = 3 * 2**20
"""Largest study that is kept in the repository [bytes]."""


def is_kept(folder, report):
    """Whether page and figures are those of a report, and small enough."""
    assert (folder / "report.md").read_text("utf-8") == markdown_page(report)
    drawn = {path.stem for path in (folder / "figures").glob("*.png")}
    assert drawn == {picture.name for picture in report.pictures}
    assert sum(path.stat().st_size for path in folder.rglob("*.*")) < MOST


def test_the_report_on_solvers_is_what_the_rows_beside_it_give(committed):
    is_kept(DEFAULT, solver_report(committed))


@pytest.mark.parametrize("name", ["sequences", "bunny_torsion"])
def test_other_reports_are_what_the_rows_beside_them_give(name):
    is_kept(STUDIES / name, study_report(STUDIES / name))


def test_the_default_study_selects_from_every_family():
    """310 of contact-qp-2, from each of its 18 families."""
    path = study_path("default")
    study = solver_study(path, toml_read(path))
    own = study.problems
    problems = problems_taken(own.source, own.families, own.most)
    families = manifest(problem_set_folder(CONTACT_QP_2))["families"].keys()
    assert {problem.facts["family"] for problem in problems} == families
    assert len(problems) == sum(study.problems.families.values()) == 310
    assert len({problem.id for problem in problems}) == 310
    assert study.limits.repetitions >= 5
    trivial = [p for p in problems if p.feasible and not p.answer.x.any()]
    assert len(trivial) <= 0.05 * len(problems)
