"""Claims: when they hold, when they fail, what the command makes of them."""

import json
import re

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.claims.claim import (
    FAILS,
    HOLDS,
    NOT_RUN,
    Claim,
    claim_result,
    comparison,
    sum_of_terms,
)
from quasistatic_ref.lab.claims.report import chapter, chapters_of, claims_page, summary
from quasistatic_ref.lab.commands import validate as command
from tests.pages import ROOT


def claim_of(*comparisons, **changes):
    words = {"sentence": "One is one.", "where": "here", "sweep": "none", "reason": "none"}
    return Claim(**{"name": "planted", "measure": lambda: comparisons} | words | changes)


@pytest.mark.parametrize(
    ("measured", "expected", "scale", "tolerance", "holds"),
    [
        ([1.0, 2.0 + 1e-9], [1.0, 2.0], 1.0, 0.0, False),
        ([1.0 + 1e-9], [1.0], 1.0, 1e-8, True),
        ([1.0 + 1e-9], [1.0], 1e-3, 1e-8, False),
        ([np.nan], [1.0], 1.0, 1e300, False),
        ([1e-30], [0.0], 0.0, 1e-12, False),
        ([], [], 1.0, 1.0, False),
    ],
)
def test_a_comparison_holds_where_every_point_is_within_tolerance(
    measured, expected, scale, tolerance, holds
):
    assert comparison("x", measured, expected, tolerance, scale).holds is holds


def test_the_scale_of_a_sum_is_its_largest_term():
    # 1 - 1 + 1e-3: relative to the sum 1e-9 would be 1e-6, relative to the largest term 1e-9.
    assert sum_of_terms("x", 1e-3 + 1e-9, [1.0, -1.0, 1e-3], 2e-9).holds
    assert not sum_of_terms("x", 1e-3 + 1e-9, [1.0, -1.0, 1e-3], 5e-10).holds


def test_a_claim_without_its_engine_is_not_run_and_says_so():
    found = claim_result(claim_of(engine="no_such_engine"))
    assert found.verdict == NOT_RUN == "not run (engine not installed)"
    assert summary(found)[0] == NOT_RUN
    assert NOT_RUN in claims_page({"Engines": [chapter(found)]})


def test_a_claim_fails_with_its_worst_comparison_or_with_an_error():
    good = comparison("good", 1.0, 1.0, 0.0)
    bad = comparison("bad", 1.0, 2.0, 0.1)
    assert claim_result(claim_of(good)).verdict == HOLDS
    assert claim_result(claim_of(good, bad)).verdict == FAILS
    assert claim_result(claim_of()).verdict == FAILS  # no evidence is no claim

    def measure():
        raise InputError("is wrong")

    broken = claim_result(claim_of(measure=measure))
    assert (broken.verdict, broken.trouble) == (FAILS, "is wrong")


def test_the_command_prints_a_table_and_writes_the_page(tmp_path, cli):
    printed = cli("validate approach locked_guide --out", tmp_path)
    assert re.search(r"^approach +holds +162 ", printed.out, re.MULTILINE)
    assert "2 holds" in printed.out
    assert "[2/2] locked_guide ... holds" in printed.err
    page = (tmp_path / "claims.md").read_text()
    assert "2 of 2 claims hold" in page
    assert [path.name for path in tmp_path.iterdir()] == ["claims.md"]


def test_a_claim_that_is_measured_again_changes_its_chapter_alone(tmp_path, cli, monkeypatch):
    committed = (ROOT / "validation" / "results" / "claims.md").read_text("utf-8")
    page = tmp_path / "claims.md"
    page.write_text(committed, "utf-8")
    bad = claim_of(comparison("weight [N]", 1.0, 2.0, 0.1), name="structure")
    monkeypatch.setattr(command, "BY_NAME", command.BY_NAME | {"structure": bad})
    cli("validate structure --out", tmp_path, status=1)
    before, after = map(chapters_of, (committed, page.read_text("utf-8")))
    assert list(after) == list(before)
    assert after.pop("structure").startswith("### structure: FAILS")
    assert before.pop("structure").startswith("### structure: holds")
    assert after == before
    count = len(before) + 1
    assert f"{count - 1} of {count} claims hold" in page.read_text("utf-8")


def test_a_claim_that_fails_ends_with_status_one_and_a_sentence(tmp_path, cli, monkeypatch):
    bad = claim_of(comparison("weight [N]", [1.0, np.nan], 2.0, 0.1))
    monkeypatch.setattr(command, "BY_NAME", {"planted": bad})
    monkeypatch.setattr(command, "CLAIMS", {"Planted": {"planted": bad}})
    printed = cli("validate --out", tmp_path, status=1)
    assert "quasistatic-ref: planted fails: weight [N] is None, not 2.0" in printed.err
    assert "FAILS" in (tmp_path / "claims.md").read_text()
    assert json.loads(cli("validate --json --out", tmp_path, status=1).out)["failed"] == ["planted"]


def test_no_claim_is_measured_for_a_folder_that_cannot_be_written(tmp_path, cli):
    (tmp_path / "file").touch()
    said = cli("validate --out", tmp_path / "file", status=2).err
    assert "cannot be written" in said
    assert "[1/" not in said


def test_an_unknown_claim_is_bad_input(tmp_path, cli):
    assert "did you mean 'approach'" in cli("validate aproach --out", tmp_path, status=2).err
