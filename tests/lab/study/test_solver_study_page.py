"""docs/solver_study.md: what it says is what the committed rows say, by plain loops."""

import math
import re
from pathlib import Path

import pytest

from quasistatic_ref.lab.study.report.rows import half_of
from tests.lab.study.plain_report import (
    agrees,
    delivered,
    picked,
    quantile,
    seconds,
)
from tests.quoted import unheld
from validation.make.study_advice import NAME, advice

VALIDATION = Path(__file__).parents[3] / "validation"
DEFAULT = VALIDATION / "studies" / "default"
PAGE = VALIDATION.parent / "docs" / "solver_study.md"
CONSTANTS = re.compile(r"1e-\d+|\d digits|at most 40|200\s+problems|all 200")
"""What the page says that is no result: accuracies, digits that count, how many problems."""
BULLET = re.compile(
    r"^- \*\*(?P<label>\S+)\*\* at `(?P<setting>\w+)` \(`.*?`\) delivers 6 digits on "
    r"(?P<six>\S+) % and 9 digits on (?P<nine>\S+) % of (?P<count>[\d,]+) problems, in "
    r"(?P<time>\S+) ms \(median\); "
    r"(?P<false>[\d,]+) of (?P<said>[\d,]+) claims of success are false"
    r"(?:, and the solver calls (?P<none>[\d,]+) solvable problems infeasible)?\.(?P<rest>.*)$",
    re.MULTILINE,
)
OWN = re.compile(
    r"Its own setting (?:is not advised: it )?delivers 6 digits on (?P<six>\S+) % of the problems; "
    r"(?P<false>[\d,]+) of (?P<said>[\d,]+) claims of success are false"
    r"(?:, and the solver calls (?P<none>[\d,]+) solvable problems infeasible)?"
)


@pytest.fixture(scope="module")
def limit(committed):
    return committed.study["time_limit"]


@pytest.fixture(scope="module")
def rows(committed):
    return [row for row in committed.rows if row["repetition"] == 0 and row["feasible"]]


@pytest.fixture(scope="module")
def text():
    return (DEFAULT / NAME).read_text("utf-8")


def whole(words):
    return int((words or "0").replace(",", ""))


def share(own, least):
    return 100 * sum(delivered(row) >= least for row in own) / len(own)


def mean_time(own, limit):
    """exp(mean log(t + 1 ms)) - 1 ms, the time limit where 6 digits were not delivered [s]."""
    late = [seconds(r, limit) if delivered(r) >= 6 else limit for r in own]
    return math.exp(sum(math.log(t + 1e-3) for t in late) / len(late)) - 1e-3


def check_claims(found, own):
    """Share with 6 digits, false claims of success, claims of infeasibility (all false here)."""
    said = [row for row in own if row["said_optimal"]]
    assert agrees(found["six"], share(own, 6))
    assert whole(found["said"]) == len(said)
    assert whole(found["false"]) == sum(row["wrong"] for row in said)
    assert whole(found["none"]) == sum(row["said_infeasible"] for row in own)


def test_the_sentences_of_the_page_are_made_of_the_committed_rows(text, committed):
    assert text == advice(committed)
    assert f"studies/default/{NAME}" in PAGE.read_text("utf-8")


def test_every_advice_is_that_of_the_rows_by_plain_loops(text, rows, limit):
    """Shares, median time and claims, of each solver named; the time limit where not solved."""
    cold = picked(rows, "units = natural, warm = false")
    compared = [r for r in cold if r["outcome"] != "not_run_budget" and half_of(r["problem"]) == 1]
    bullets = list(BULLET.finditer(text))
    assert len(bullets) == len({row["solver"] for row in compared}) >= 8
    for found in bullets:
        where = f"label = {found['label']}, setting = {found['setting']}"
        own = picked(compared, where)
        assert whole(found["count"]) == len(own)
        check_claims(found, own)
        assert agrees(found["nine"], share(own, 9))
        assert agrees(found["time"], 1e3 * quantile([seconds(r, limit) for r in own], 0.5))
        if plain := OWN.search(found["rest"]):
            check_claims(plain, picked(compared, f"label = {found['label']}, setting = default"))
        for count, family in re.findall(r"(\d+) of `(\S+)`", found["rest"]):
            assert int(count) == sum(r["family"] == family and delivered(r) < 6 for r in own)
        missed = re.search(r"misses 6 digits on ([\d,]+) problem", found["rest"])
        assert whole(missed and missed[1]) == sum(delivered(row) < 6 for row in own)


def test_a_solver_is_advised_at_no_setting_with_later_digits(text, rows, limit):
    """On the other half no setting of the same interface has a lower mean time to 6 digits."""
    cold = picked(rows, "units = natural, warm = false")
    compared = [r for r in cold if r["outcome"] != "not_run_budget" and half_of(r["problem"]) == 0]
    for found in BULLET.finditer(text):
        own = picked(compared, f"label = {found['label']}")
        means = {
            setting: mean_time(picked(own, f"setting = {setting}"), limit)
            for setting in {row["setting"] for row in own}
        }
        assert found["setting"] == min(means, key=means.get)


def test_claims_of_the_whole_study_are_counted(text, committed):
    rows = [row for row in committed.rows if row["repetition"] == 0]
    counts = re.search(
        r"Of ([\d,]+) claims of success, ([\d,]+) are false; of ([\d,]+) claims that there is "
        r"no solution, ([\d,]+) are false\.", text)  # fmt: skip
    optimal = [row["wrong"] for row in rows if row["said_optimal"]]
    infeasible = [row["wrong"] for row in rows if row["said_infeasible"]]
    assert [whole(count) for count in counts.groups()] == [
        len(optimal), sum(optimal), len(infeasible), sum(infeasible)]  # fmt: skip


def test_the_page_has_no_number_that_is_not_made():
    assert unheld(PAGE.read_text("utf-8"), [], CONSTANTS) == []
