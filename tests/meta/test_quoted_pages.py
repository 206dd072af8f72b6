"""Numbers and printed output in README and docs/ are those of the results that they come from."""

import pytest

from quasistatic_ref.lab.vectors.check.patched import program
from tests.lab.vectors.committed_cases import answer_file, cases
from tests.quoted import QUOTED, ROOT, expected_phrases, flat, outside, printed_blocks, stale

PAGES = sorted(
    str(path.relative_to(ROOT)) for path in (ROOT / "README.md", *(ROOT / "docs").rglob("*.md"))
)

PRINTED = {
    "README.md": "tests/meta/test_readme.py",
    "docs/contributing.md": "tests/meta/test_reading_path.py: the calls of a step",
    "docs/quickstart.md": "tests/quoted.toml: the lines of demo",
    "docs/guides/ask_step_by_step.md": "tests/lab/oracle/test_compare.py",
    "docs/guides/check_your_implementation.md": "below",
    "docs/guides/does_my_contact_hold.md": "tests/optional/guests/test_opinion.py",
    "docs/findings.md": "tests/optional/doctor/test_observer.py and test_findings.py",
}
"""Pages with text that a command printed, and what holds it."""


def text(page):
    return (ROOT / page).read_text("utf-8")


@pytest.mark.parametrize("page", QUOTED)
def test_every_quoted_number_is_that_of_its_source(page):
    wrong = stale(text(page), expected_phrases(page))
    assert not wrong, f"{page} ought to read:\n" + "\n".join(wrong)


@pytest.mark.parametrize("page", [page for page, own in QUOTED.items() if "given" in own])
def test_every_number_with_a_unit_has_a_source_or_is_given_by_the_page(page):
    assert sorted(set(outside(text(page), expected_phrases(page)))) == QUOTED[page]["given"]


def test_every_page_with_printed_text_has_a_test_of_it():
    assert [page for page in PAGES if printed_blocks(text(page))] == sorted(PRINTED)


def test_a_runner_that_forgets_h_is_answered_as_the_page_shows(tmp_path, cli):
    for layer, change in (("rows", {}), ("wrench", {"h": 1.0})):
        outputs = {c.id: program()(layer, c.input | change) for c in cases(layer)}
        answer_file(tmp_path, layer, outputs, implementation="mine")
    said = cli("vectors", "check", tmp_path, "--layer", "rows", "--layer", "wrench", status=1)
    (shown,) = printed_blocks(text("docs/guides/check_your_implementation.md"))
    assert flat(said.out + said.err) == flat(shown)


def test_a_number_that_changed_is_named_with_its_sentence():
    phrases = ["turns by 49.9 degrees in 300 steps"]
    assert stale("It\nturns by 49.9 degrees in 300 steps.", phrases) == []
    assert stale("It turns by 49.8 degrees in 300 steps.", phrases) == phrases


def test_a_number_without_a_source_is_found():
    page = "It turns by 49.9 degrees\nin 300 steps of -0.5 mm.\n```text\n3 N\n```\n"
    assert outside(page, ["by 49.9 degrees in"]) == ["300 steps", "-0.5 mm"]
