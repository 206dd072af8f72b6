"""Reports on stores that are packed, cut off, hardly begun, or empty."""

import pytest
from matplotlib import pyplot as plt

from quasistatic_ref import InputError
from quasistatic_ref.lab.figures.study_images import figure_of
from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.study.report.report import study_report
from quasistatic_ref.lab.study.store.pack import shorter
from quasistatic_ref.lab.study.store.store import Store, contents
from quasistatic_ref.lab.sweep import TABLE
from tests.lab.study import made_store, plain_report


@pytest.fixture(scope="module")
def rows(store):
    return contents(store).rows


def made_of(folder, rows):
    """The store with these rows."""
    with Store(folder, made_store.STUDY, made_store.facts(12)) as store:
        store.add(*rows)


def test_a_packed_store_says_the_same_of_digits_and_claims(store, tmp_path, cli):
    cli("study", "pack", store, "--out", tmp_path)
    short = contents(tmp_path).rows
    assert [shorter(row) for row in short] == short
    for row, whole in zip(short, contents(store).rows, strict=True):
        assert row["wrong"] == whole["wrong"]
        digits = whole["digits"]["delta_q"]
        if digits is not None:
            assert digits - 1.001e-3 < row["digits"]["delta_q"] <= digits
    packed_tables = plain_report.tables_of(markdown_page(study_report(tmp_path)))
    for (title, _, columns, body), (_, _, _, whole) in zip(
        packed_tables, plain_report.tables_of(markdown_page(study_report(store))), strict=True
    ):
        for k, column in enumerate(columns):
            if ">=" in column or "wrong" in title:
                assert [line[k] for line in body] == [line[k] for line in whole], title


def test_a_store_without_rows_is_refused(tmp_path):
    made_of(tmp_path, [])
    with pytest.raises(InputError, match="holds no rows yet"):
        study_report(tmp_path)


CUT = {
    "one row": lambda row: row["problem"] == "stack/0/0" and row["solver"] == "bee",
    "no problem in common": lambda row: (
        (row["solver"] == "ant") == (row["problem"] == "door/1/0") and row["setting"] == "mid"
    ),
}


@pytest.mark.parametrize("keep", CUT.values(), ids=CUT)
def test_a_study_that_has_hardly_begun_is_reported_too(rows, tmp_path, keep):
    kept = [row for row in rows if keep(row)]
    made_of(tmp_path, kept)
    report = study_report(tmp_path)
    counts = [
        t for t in plain_report.tables_of(markdown_page(report)) if t[0].startswith("How the")
    ]
    first = [row for row in kept if row["repetition"] == 0]
    assert sum(int(line[1]) for line in counts[0][3]) == len(first)
    for picture in report.pictures:
        plt.close(figure_of(picture.kind, picture.data))


def test_nothing_is_drawn_of_calls_that_were_not_made(rows, tmp_path):
    missed = {"outcome": "not_run_budget", "said_optimal": False, "wrong": False}
    made_of(tmp_path, [row | missed for row in rows])
    report = study_report(tmp_path)
    assert report.pictures == ()
    assert "the figure `profiles` is not drawn" in markdown_page(report)


def test_a_report_and_a_packed_store_stand_next_to_what_they_are_of(tmp_path, cli):
    (tmp_path / TABLE).write_text(made_store.SWEEP)
    assert f"wrote {tmp_path / 'report' / 'report.html'}\n" in cli("study", "report", tmp_path).out
    assert (tmp_path / "report" / "figures" / "sweep.png").stat().st_size > 1000
    folder = tmp_path / "store"
    made_store.write_store(folder, count=3)
    assert f"wrote {folder / 'packed' / 'study.json.xz'}\n" in cli("study", "pack", folder).out
