"""The committed study: its summary is what the rows beside it give, by plain loops, too."""

from collections import Counter
from itertools import product
from statistics import median

import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.study.default import default_problems
from tests.lab.study.asked import page, page_written, table_of
from tests.pages import ROOT

STUDIES = ROOT / "validation" / "studies"
pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def table(committed):
    return table_of(committed)


def cells(text, start):
    """The cells of the lines of a page that begin with some words."""
    lines = [line for line in text.splitlines() if line.startswith(f"| {start} |")]
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in lines]


def test_the_summary_is_what_the_rows_beside_it_give(table):
    assert (STUDIES / "default" / "summary.md").read_text("utf-8") == page(table)


def test_the_accuracy_reached_is_that_of_the_residuals_beside_it(committed):
    for row in committed:
        sizes = (row.primal, row.dual, row.gap)
        accuracy = row.accuracy
        wanted = accuracy and all(size is not None and size <= accuracy for size in sizes)
        assert row.reached == wanted, row
        assert (accuracy is None) == (row.setting == "default")


def test_lines_of_the_tables_by_loops_over_the_rows(committed, table):
    text = page(table)
    natural = [row for row in committed if row.units == "natural"]
    osqp = [row for row in natural if (row.door, row.solver) == ("qpsolvers", "osqp")]
    high = [row for row in osqp if row.setting == "high" and row.feasible]
    digits = [row.digits if row.says == "solved" else 0.0 for row in high]
    (line,) = cells(text.partition("## Performance profile")[0], "qpsolvers:osqp")
    shares = [f"{100 * sum(d >= most for d in digits) / len(digits):.1f}" for most in (6, 3)]
    assert line[1:6] == ["high", str(len(high)), *shares, f"{median(digits):.1f}"]
    assert float(line[6]) == pytest.approx(1e3 * median(row.seconds for row in high), 1e-2)
    said = Counter((row.says, row.reached, row.feasible) for row in natural)
    ((*counts,),) = cells(text, "all")
    reached = {key[1] for key in said}  # None where no accuracy was asked for
    wanted = [sum(said["infeasible", some, one] for some in reached) for one in (True, False)]
    wanted.append(sum(count for key, count in said.items() if key[0] == "other"))
    wanted += [said["solved", *one] for one in product((False, True, None), (False, True))]
    assert sorted(counts[1:]) == sorted(f"{count:,}" for count in wanted)


@pytest.mark.parametrize(("setting", "count"), [("tuned", 16), ("high", 15), ("mid", 0)])
def test_in_how_many_families_an_accuracy_that_is_reached_gives_six_digits(table, setting, count):
    """In 95 % of the answers, as docs/studies.md says."""
    answers = table[
        (table["setting"] == setting)
        & (table["units"] == "natural")
        & (table["says"] == "solved")
        & table["reached"].eq(True)
        & table["feasible"]
    ]
    shares = (answers["digits"] >= 6).groupby(answers["family"]).mean()
    assert len(shares) == 16
    assert (shares >= 0.95).sum() == count


def test_the_page_is_written_with_its_figures(committed, tmp_path):
    paths = page_written(committed[::50], tmp_path)
    names = [path.relative_to(tmp_path).as_posix() for path in paths]
    drawn = ("digits_time", "reached_digits", "performance_profile", "shifted_means")
    assert names == ["summary.md", *(f"figures/{name}.png" for name in drawn)]
    with pytest.raises(InputError, match="there are no rows to show; run the study first"):
        page_written([], tmp_path)


def test_the_default_study_selects_the_problems_of_the_committed_rows(committed):
    problems, part = default_problems()
    ids = {one.id for one in problems}
    assert len(problems) == 310
    assert ids == {row.problem for row in committed}
    assert {one.id for one in part} < ids
