"""Rows are only ever added; what a sudden end leaves is read, or refused in one sentence."""

import json
import resource

import pytest

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.measuring.environment import UNKNOWN
from quasistatic_ref.lab.study.measuring.grade import CLOCKS, ungraded
from quasistatic_ref.lab.study.store.store import ROWS, Store, rows_read, study_read, table

STUDY = {"format": "quasistatic-ref/study-store", "version": 2, "kind": "solvers"}


SECONDS = dict.fromkeys(CLOCKS) | {"call": 1.0, "spent": 1.0}


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
    measured = ("seconds", "calls", "clock_agrees", "memory")
    assert kept == {k: v for k, v in row("a").items() if k not in measured}


def test_a_store_is_plain_json_lines(tmp_path):
    with Store(tmp_path, STUDY) as store:
        store.add(row("a"))
    assert json.loads((tmp_path / ROWS).read_text()) == row("a")


OLD = {"problem": "a", "family": "f", "solver": "s", "road": "qpsolvers", "setting": "default",
       "warm": False, "units": "raw", "repetition": 0, "outcome": "failed",
       "claimed": "PROXQP_PRIMAL_INFEASIBLE", "said_optimal": False, "wrong": False,
       "digits": {"delta_q": None, "net_wrench": None}, "residuals": {}, "iterations": None,
       "seconds": {"solver": 0.1, "call": 1.0, "spent": 1.0}}  # fmt: skip


def test_rows_of_version_1_are_read_with_what_they_did_not_measure_null(tmp_path):
    """An interface was a road; a claim that there is no solution was no false claim."""
    (tmp_path / ROWS).write_text(json.dumps(OLD) + "\n")
    solvers = [{"name": "s", "road": "qpsolvers", "options": {}}]
    (tmp_path / "study.json").write_text(json.dumps(STUDY | {"version": 1, "solvers": solvers}))
    (read,) = rows_read(tmp_path)
    assert (read["interface"], read["said_infeasible"], read["wrong"]) == ("qpsolvers", True, True)
    assert (read["memory"], read["calls"], read["seconds"]["call"]) == (None, 1, 1.0)
    assert read["seconds"]["solver"] is None  # it was qpsolvers' clock
    (solver,) = study_read(tmp_path)["solvers"]
    assert solver == {"name": "s", "interface": "qpsolvers", "options": {}}
    with pytest.raises(InputError, match="a store of version 1, which is read and reported but"):
        Store(tmp_path, STUDY)


def begun(*names, eps=1e-3):
    solvers = [
        {"name": n, "interface": "callable", "target": "m:f", "options": {"high": {"eps": eps}}}
        for n in names
    ]
    settings = [{"name": "high", "accuracy": 1e-9}]
    return STUDY | {"solvers": solvers, "settings": settings, "runs": [list(names)],
                    "versions": {}, "machine": {"cores": 2, "load": str(names)}}  # fmt: skip


def test_solvers_come_and_go_while_a_study_goes_on(tmp_path):
    for names, gone in (
        (["a", "b"], []), (["b", "c"], ["callable:a"]), (["a", "b"], ["callable:c"])
    ):  # fmt: skip
        with Store(tmp_path, begun(*names)) as store:
            if "a" in names and not store.rows:
                store.add(row("x", solver="a"))
            assert len(store.rows) == 1  # a's rows wait for it to come back
        there = study_read(tmp_path)
        assert [solver["name"] for solver in there["solvers"]] == names
        assert there.get("removed", []) == gone
    with pytest.raises(InputError, match=r"another 'solvers\.callable:a'"):
        Store(tmp_path, begun("a", eps=1e-6))


def test_a_store_begun_before_facts_were_unknown_goes_on(tmp_path):
    """A fact that the system does not report was written "not told", today "unknown"."""
    old, new = (
        begun("a") | {"machine": {"cores": 2, "governor": words}} for words in ("not told", UNKNOWN)
    )
    (tmp_path / "study.json").write_text(json.dumps(old))
    with Store(tmp_path, new):
        assert json.loads((tmp_path / "study.json").read_text())["machine"] == new["machine"]
