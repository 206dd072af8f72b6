"""Results of several machines in one store: every row once, or a sentence that says why not."""

import json
import os

import pytest

from quasistatic_ref import InputError
from quasistatic_ref.cli.main import main
from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.study.report.report import study_report
from quasistatic_ref.lab.study.store.merge import merged_store, part_read
from quasistatic_ref.lab.study.store.store import Store, contents
from tests.lab.study import made_store, plain_report

SET = {"problems": {"sha256": "a"}}


def store_of(folder, seed, **fields):
    """A store of a machine; another seed gives other rows of the same measurements."""
    return made_store.write_store(folder, seed=seed, **SET | fields)


@pytest.fixture(scope="module")
def stores(tmp_path_factory):
    """Two machines that ran the same study, and their rows; tests leave both as they are."""
    folder = tmp_path_factory.mktemp("machines")
    return folder, {"fast": store_of(folder / "fast", 3), "slow": store_of(folder / "slow", 4)}


@pytest.fixture(scope="module")
def both(stores):
    """The folder of their merged store."""
    folder, _ = stores
    return merged_store(parts(folder / "fast", folder / "slow"), folder / "both")


def parts(*folders):
    return [part_read(str(folder)) for folder in folders]


def without_machine(row):
    return {name: value for name, value in row.items() if name != "machine"}


def key(row):
    return json.dumps(without_machine(row), sort_keys=True)


def test_every_row_of_every_machine_is_there_once_with_its_machine(stores, both, tmp_path):
    """Of two machines, and of these two merged once more with a third."""
    _, own = stores
    third = store_of(tmp_path / "third", 5)
    for out, of in (
        (both, own),
        (merged_store(parts(both, tmp_path / "third"), tmp_path / "three"), own | {"third": third}),
    ):
        found = contents(out)
        assert found.study["machines"] == list(of)
        assert len(found.rows) == sum(map(len, of.values()))
        for name, rows in of.items():
            there = [without_machine(row) for row in found.rows if row["machine"] == name]
            assert sorted(map(key, there)) == sorted(map(key, rows))
    with pytest.raises(InputError, match="holds merged results"):
        Store(both, contents(both).study)


def test_machines_are_lines_of_tables_and_compared_on_the_same_problems(both):
    """The report of the merged store against its rows; cat is called on 9 problems of 12."""
    rows = [row for row in contents(both).rows if row["repetition"] == 0]
    tables = plain_report.tables_of(markdown_page(study_report(both)))
    assert plain_report.checked_count(tables, rows, made_store.LIMIT) > 300
    found = plain_report.lines(tables, titled="Setting mid")
    assert len(found) == 2 * len(made_store.SOLVERS)
    for _, _, _, (solver, _, _, calls, *_) in found:
        assert int(calls) == (9 if solver == "cat" else 12)
    assert plain_report.lines(tables, titled="Machines")


def test_rows_are_never_counted_twice_under_whatever_name(stores, both, tmp_path):
    folder, _ = stores
    fast = folder / "fast"
    slow = folder / "slow"
    main(["study", "pack", str(fast), "--out", str(tmp_path / "short")])
    for one, other, words in (
        (fast, f"copy={fast}", "give each only once"),
        (fast, tmp_path / "short", "give each only once"),
        (both, f"other={slow}", "give each only once"),
        (f"one={fast}", f"one={slow}", "where these are different machines"),
    ):
        with pytest.raises(InputError, match=words):
            merged_store(parts(one, other), tmp_path / "out")
    with pytest.raises(InputError, match="was merged already, of fast, slow"):
        part_read(f"name={both}")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(("fields", "words"), [
    ({"problems": {"sha256": "b"}}, "another problems, by their hash"),
    ({"time_limit": 2.0}, "another time_limit"),
])  # fmt: skip
def test_results_of_another_study_are_refused_by_what_differs(stores, tmp_path, fields, words):
    folder, _ = stores
    store_of(tmp_path / "other", 4, count=1, **fields)
    with pytest.raises(InputError, match=words):
        merged_store(parts(folder / "fast", tmp_path / "other"), tmp_path / "out")
    assert os.listdir(tmp_path) == ["other"]


def test_a_folder_that_cannot_be_merged_is_refused(tmp_path):
    with Store(tmp_path, made_store.STUDY | SET):
        pass
    with pytest.raises(InputError, match="holds no rows yet"):
        part_read(str(tmp_path))
    store_of(tmp_path / "unsaid", 3, count=1, problems={})
    with pytest.raises(InputError, match="does not say which problems"):
        part_read(str(tmp_path / "unsaid"))


def test_a_store_is_written_whole_or_not_at_all(stores, both, tmp_path, monkeypatch):
    """The rename that ends the writing fails, as where the disk is full; nothing is left."""
    folder, _ = stores
    own = parts(folder / "fast", folder / "slow")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.rename", full)
    with pytest.raises(InputError, match="No space left"):
        merged_store(own, tmp_path / "out")
    assert os.listdir(tmp_path) == []
    with pytest.raises(InputError, match="is there already"):
        merged_store(own, both)
