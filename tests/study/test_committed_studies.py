"""The committed studies: each report is what the rows beside it give."""

import json
import re
from pathlib import Path

import pytest

from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.study.report import study_report
from quasistatic_ref.lab.study.solver_report import solver_report
from quasistatic_ref.lab.study.store import rows_read, study_read

STUDIES = Path(__file__).parents[2] / "validation" / "studies"
DEFAULT = STUDIES / "default"
MOST = 3 * 2**20
"""Largest study that is kept in the repository [bytes]."""


@pytest.fixture(scope="module")
def rows():
    return rows_read(DEFAULT)


@pytest.fixture(scope="module")
def facts():
    text = (DEFAULT / "problems.jsonl").read_text("utf-8")
    return [json.loads(line) for line in text.splitlines()]


def is_kept(folder, report):
    """Whether page and figures are those of a report, and small enough."""
    assert (folder / "report.md").read_text("utf-8") == markdown_page(report)
    drawn = {path.stem for path in (folder / "figures").glob("*.png")}
    assert drawn == {picture.name for picture in report.pictures}
    assert sum(path.stat().st_size for path in folder.rglob("*.*")) < MOST


def test_the_report_on_solvers_is_what_the_rows_beside_it_give(rows, facts):
    is_kept(DEFAULT, solver_report(study_read(DEFAULT), facts, rows))


def test_the_report_on_the_grip_is_what_the_rows_beside_it_give():
    is_kept(STUDIES / "bunny_torsion", study_report(STUDIES / "bunny_torsion"))


def test_the_page_on_which_solver_to_use_shows_the_table_of_the_report():
    page = (STUDIES.parents[1] / "docs" / "solver_study.md").read_text("utf-8")
    directly = re.compile(r"^\| \w+ \| qpsolvers \| .*$", re.MULTILINE)
    shown = directly.findall(page)
    report = (DEFAULT / "report.md").read_text("utf-8").partition("**Time to 6 digits")[2]
    assert len(shown) >= 8
    assert shown == directly.findall(report.partition("\n**")[0])


def test_the_committed_study_is_of_eight_solvers_and_two_thousand_problems(rows, facts):
    ids = {fact["id"] for fact in facts}
    assert len(ids) == study_read(DEFAULT)["problems"]["count"] >= 2000
    assert len({row["solver"] for row in rows}) >= 8
    assert {row["problem"] for row in rows} == ids
