"""Rows are only ever added; what a sudden end leaves is read, or refused in one sentence."""

import json
import resource

import pytest

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.grade import ungraded
from quasistatic_ref.lab.study.store import ROWS, Store, rows_read, study_read, table

STUDY = {"format": "quasistatic-ref/study-store", "version": 2, "kind": "solvers"}


SECONDS = {"solver": None, "call": 1.0, "spent": 1.0}


def row(problem, **changes):
    named = {"problem": problem, "family": "f", "solver": "s", "interface": "callable"}
    named |= {"setting": "default", "warm": False, "units": "raw", "repetition": 0}
    return named | ungraded("failed", "sorry", 1.0) | {"seconds": SECONDS} | changes


def test_rows_come_back_sorted_whatever_their_order_in_the_file(tmp_path):
    with Store(tmp_path, STUDY) as store:
        for name in ("b", "c", "a"):
            store.add(row(name))
    assert [r["problem"] for r in rows_read(tmp_path)] == ["a", "b", "c"]


@pytest.mark.parametrize("torn", ['{"prob', "\x00\x00", "{}\n", "[1]\n", '{"problem": "x"}\n'])
def test_a_torn_last_line_is_dropped_and_the_store_goes_on(tmp_path, torn):
    with Store(tmp_path, STUDY) as store:
        store.add(row("a"))
    with (tmp_path / ROWS).open("a") as file:
        file.write(torn)
    assert [r["problem"] for r in rows_read(tmp_path)] == ["a"]
    with Store(tmp_path, STUDY) as store:
        assert len(store.keys) == 1
        store.add(row("b"))
    assert [r["problem"] for r in rows_read(tmp_path)] == ["a", "b"]


def test_a_broken_line_in_the_middle_is_refused_by_its_number(tmp_path):
    with Store(tmp_path, STUDY) as store:
        store.add(row("a"))
    text = (tmp_path / ROWS).read_text()
    (tmp_path / ROWS).write_text(text + "{broken\n" + text)
    with pytest.raises(InputError, match=r"rows\.jsonl: line 2: is no row"):
        rows_read(tmp_path)


def test_every_prefix_of_a_store_is_a_store(tmp_path):
    """Whatever a sudden end leaves of the file, all rows but the torn one are there."""
    with Store(tmp_path, STUDY) as store:
        for name in ("a", "b", "c"):
            store.add(row(name))
    content = (tmp_path / ROWS).read_bytes()
    for length in range(0, len(content) + 1, 7):
        (tmp_path / ROWS).write_bytes(content[:length])
        assert len(rows_read(tmp_path)) == content[:length].count(b"\n")


def test_another_study_in_the_folder_is_refused_by_the_field_that_differs(tmp_path):
    with Store(tmp_path, STUDY | {"budget": 1.0}):
        pass
    with pytest.raises(InputError, match="another 'budget'"):
        Store(tmp_path, STUDY | {"budget": 2.0})


def test_two_runs_cannot_write_one_store(tmp_path):
    with Store(tmp_path, STUDY), pytest.raises(InputError, match="being written by another run"):
        Store(tmp_path, STUDY)
    with Store(tmp_path, STUDY):
        pass  # after the end of the first, it is free again


def test_a_full_disk_is_reported_by_the_name_of_the_file_and_loses_no_row(tmp_path):
    """A limit on the size of files ends a write in the middle of a line, as a full disk does."""
    with Store(tmp_path, STUDY) as store:
        store.add(row("a"))
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(
            resource.RLIMIT_FSIZE, ((tmp_path / ROWS).stat().st_size + 10, limits[1])
        )
        try:
            with pytest.raises(InputError, match=r"rows\.jsonl: cannot be written: File too large"):
                store.add(row("b"))
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    with Store(tmp_path, STUDY) as store:
        assert [r["problem"] for r in store.rows] == ["a"]
        store.add(row("b"))
    assert [r["problem"] for r in rows_read(tmp_path)] == ["a", "b"]


def test_a_store_whose_rows_are_a_folder_is_refused_by_name(tmp_path):
    (tmp_path / ROWS).mkdir()
    with pytest.raises(InputError, match=r"rows\.jsonl: cannot be written: Is a directory"):
        Store(tmp_path, STUDY)


def test_a_table_leaves_out_times_and_nothing_else():
    (kept,) = table([row("a")])
    assert kept == {k: v for k, v in row("a").items() if k != "seconds"}


def test_a_store_is_plain_json_lines(tmp_path):
    with Store(tmp_path, STUDY) as store:
        store.add(row("a"))
    assert json.loads((tmp_path / ROWS).read_text()) == row("a")


def test_rows_of_version_1_are_read_with_the_interface_they_called_a_road(tmp_path):
    old = {"road" if name == "interface" else name: value for name, value in row("a").items()}
    (tmp_path / ROWS).write_text(json.dumps(old) + "\n")
    solvers = [{"name": "s", "road": "callable", "options": {}}]
    (tmp_path / "study.json").write_text(json.dumps(STUDY | {"version": 1, "solvers": solvers}))
    assert rows_read(tmp_path) == [row("a")]
    assert study_read(tmp_path)["solvers"] == [
        {"name": "s", "interface": "callable", "options": {}}
    ]
    with pytest.raises(InputError, match="a store of version 1, which is read and reported but"):
        Store(tmp_path, STUDY)
