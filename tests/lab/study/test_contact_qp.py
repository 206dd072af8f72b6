"""The table of four solvers at both ends of each dial."""

import sys

from tests.quoted_sources import table
from validation.make import contact_qp


def test_a_sample_of_the_table_has_the_digits_of_each_solver(tmp_path, monkeypatch):
    """A problem of seven families: one of nearly touching contacts, and one without a solution."""
    page = tmp_path / "page.md"
    monkeypatch.setattr(sys, "argv", ["", "--every", "211", "--out", str(page)])
    contact_qp.main()
    rows = {(row["family"], row["solver"]): row for row in table(page)}
    for solver in contact_qp.SOLVERS:
        gaps = rows["`gaps`", solver]
        assert float(gaps["digits of nine in ten, easy fifth"]) > 7
        assert gaps["solved [%], hard"] == "100.0"
        assert int(gaps["iterations, hard"]) > 0
        assert rows["`jammed`", solver]["of the hard fifth"] == ""
