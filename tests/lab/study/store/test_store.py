"""Rows are added whole; what no study has written is refused in one sentence."""

import resource
import sqlite3
from contextlib import closing

import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.study.store import store as stores
from quasistatic_ref.lab.study.store.pack import packed_store
from quasistatic_ref.lab.study.store.rows import flat, key_of, nested
from quasistatic_ref.lab.study.store.store import PACKED, STORE, Store, contents, packed_tables
from tests.lab.study import made_store


@pytest.fixture
def rows(tmp_path):
    """Those of a store in ``tmp_path / "store"``, sorted."""
    return sorted(made_store.write_store(tmp_path / "store", count=2), key=key_of)


@pytest.fixture
def folder(tmp_path, rows):
    return tmp_path / "store"


def change(folder, statement):
    """Change a store behind its back: its schema is not asked."""
    tables = sqlite3.connect(folder / STORE)
    with tables:
        tables.execute("PRAGMA ignore_check_constraints = ON")
        tables.execute(statement)
    tables.close()


def test_rows_come_back_whole_and_sorted(folder, rows):
    assert contents(folder).rows == rows
    assert nested(flat(rows[0])) == rows[0]


def test_rows_are_in_the_file_all_together_or_not_at_all(folder, rows):
    """A row that is there already ends the transaction, and the one before it is not there."""
    with Store(folder, made_store.STUDY, made_store.facts(2)) as store:
        new = rows[0] | {"repetition": 7}
        with pytest.raises(InputError, match="cannot be written: UNIQUE"):
            store.add(new, rows[0])
        assert contents(folder).rows == rows
        store.add(new)
    assert len(contents(folder).rows) == len(rows) + 1


def test_another_study_in_the_folder_is_refused_by_the_field_that_differs(folder):
    with pytest.raises(InputError, match="another 'time_limit'"):
        Store(folder, made_store.STUDY | {"time_limit": 2.0})


def test_a_store_that_was_not_made_whole_is_made_again(tmp_path, monkeypatch):
    def killed(*given):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(stores, "about_written", killed)
        with pytest.raises(KeyboardInterrupt):
            Store(tmp_path, made_store.STUDY, made_store.facts(2))
    with Store(tmp_path, made_store.STUDY, made_store.facts(2)):
        assert contents(tmp_path).rows == []
    assert [path.name for path in tmp_path.iterdir()] == [STORE]


def test_two_runs_cannot_write_one_store(folder):
    with Store(folder, made_store.STUDY, made_store.facts(2)):
        with pytest.raises(InputError, match="being written by another run"):
            Store(folder, made_store.STUDY)
        assert contents(folder).rows  # it can be read meanwhile
    with Store(folder, made_store.STUDY, made_store.facts(2)):
        pass  # after the end of the first, it is free again


def test_a_full_disk_is_reported_by_the_name_of_the_file_and_loses_no_row(folder, rows):
    """A limit on the size of files ends a write, as a full disk does."""
    with Store(folder, made_store.STUDY, made_store.facts(2)) as store:
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, ((folder / STORE).stat().st_size, limits[1]))
        try:
            with pytest.raises(InputError, match=r"study\.sqlite: cannot be written"):
                store.add(*(row | {"repetition": 7 + k} for k in range(9) for row in rows))
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert contents(folder).rows == rows


def test_solvers_come_and_go_while_a_study_goes_on(folder, rows):
    for names in (["ant", "bee"], ["bee"], ["ant", "bee", "cat"]):
        solvers = [one for one in made_store.STUDY["solvers"] if one["name"] in names]
        with Store(folder, made_store.STUDY | {"solvers": solvers}, made_store.facts(2)) as store:
            assert len(store.rows) == len(rows)  # rows wait for their solver to come back
        found = contents(folder)
        assert {one["name"] for one in found.study["solvers"]} == set(names)
        assert {row["solver"] for row in found.rows} == set(names)
    solvers[0] = solvers[0] | {"options": {"mid": {"eps": 7.0}}}
    with pytest.raises(InputError, match="another 'solver or options qpsolvers:ant'"):
        Store(folder, made_store.STUDY | {"solvers": solvers})


SPOILT = {
    "an outcome that there is not": "UPDATE rows SET outcome = 'won'",
    "a time before its begin": "UPDATE rows SET seconds_call = -1.0",
    "infinite digits": "UPDATE rows SET digits_delta_q = 9e999",
    "a claim that is no truth value": "UPDATE rows SET wrong = 2",
    "a name without end": "UPDATE problems SET family = hex(zeroblob(2000))",
    "a solver of no study": "UPDATE rows SET solver = 'dog' WHERE interface = 'cvxpy'",
    "a setting without options": "DELETE FROM options",
    "a problem of no study": "DELETE FROM problems",
    "no study": "DELETE FROM study",
    "two studies": "INSERT INTO study SELECT * FROM study",
    "a limit of less than nothing": "UPDATE study SET time_limit = -1",
    "a machine of words": "UPDATE machines SET facts = '3'",
    "what is no JSON": "UPDATE options SET options = '{'",
    "no rows at all": "DROP TABLE rows",
    "a column more": "ALTER TABLE rows ADD COLUMN price REAL",
}


@pytest.mark.parametrize("statement", SPOILT.values(), ids=SPOILT)
def test_what_no_study_has_written_is_refused(folder, statement):
    change(folder, statement)
    with pytest.raises(InputError, match="holds what no study has written") as refused:
        contents(folder)
    assert "\n" not in str(refused.value)


def test_a_sweep_of_an_earlier_version_is_named_as_one(folder):
    change(folder, "CREATE TABLE old AS SELECT 'sweep' AS kind, NULL AS time_limit, '{}' AS facts")
    change(folder, "DROP TABLE study")
    change(folder, "ALTER TABLE old RENAME TO study")
    with pytest.raises(InputError, match="is a sweep of an earlier version; run it again"):
        contents(folder)


@pytest.mark.parametrize(
    "number",
    ["residuals_gap = 9e999", "seconds_call = 9e999", "residuals_primal = -9e999"],
)
def test_an_infinite_number_is_refused(folder, tmp_path, number):
    """A study writes none in the place of a number that is not finite."""
    change(folder, f"UPDATE rows SET {number}")
    with pytest.raises(InputError, match="written: a number that is not finite"):
        packed_store(folder, tmp_path / "out")


def test_an_infinite_number_in_json_is_refused(folder):
    change(folder, "UPDATE machines SET facts = '{\"cores\": 9e999}'")
    with pytest.raises(InputError, match="written: a number that is not finite"):
        contents(folder)


@pytest.mark.parametrize("content", [b"", b"[]", bytes(5000), b"SQLite format 3\0" + bytes(90)])
def test_a_file_of_something_else_is_refused(folder, content):
    (folder / STORE).write_bytes(content)
    with pytest.raises(InputError, match="holds what no study has written"):
        contents(folder)


@pytest.mark.parametrize("tables", [[], {}, {"rows": {"a b": [1]}}])
def test_packed_tables_of_something_else_are_refused(tmp_path, tables):
    (tmp_path / PACKED).write_bytes(packed_tables(tables))
    with pytest.raises(InputError, match="holds what no study has written"):
        contents(tmp_path)


def test_packed_tables_that_unpack_without_end_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(stores, "LARGEST_UNPACKED", 2**16)
    (tmp_path / PACKED).write_bytes(packed_tables({"rows": {"a": [0] * 2**16}}))
    with pytest.raises(InputError, match=r"holds more than 0\.0625 MiB"):
        contents(tmp_path)
    (tmp_path / PACKED).write_bytes(packed_tables({})[:-4])
    with pytest.raises(InputError, match="is no xz file, or was cut off"):
        contents(tmp_path)


ENDLESS = "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) SELECT x FROM n"


@pytest.mark.parametrize(
    ("spoilt", "says"),
    [
        ("DROP TABLE rows; CREATE VIEW rows AS " + ENDLESS, "written: a view, or a trigger"),
        (
            "CREATE TRIGGER more AFTER DELETE ON settings BEGIN DELETE FROM rows; END",
            "written: a view, or a trigger",
        ),
        (
            "DROP TABLE unreached;"
            "CREATE TABLE unreached (solver, reason AS (hex(zeroblob(20000000))));"
            "INSERT INTO unreached (solver) VALUES ('a'), ('b')",
            "holds more than 64 MiB",
        ),
        (
            "DROP TABLE unreached;"
            "CREATE TABLE unreached (solver, reason AS (zeroblob(900000000)));"
            "INSERT INTO unreached (solver) VALUES ('a')",
            "written: string or blob too big",
        ),
    ],
)
def test_a_store_that_computes_what_it_holds_is_refused(folder, spoilt, says):
    with closing(sqlite3.connect(folder / STORE)) as tables:
        tables.executescript(spoilt)
    with pytest.raises(InputError, match=says):
        contents(folder)


def test_a_folder_without_a_store_is_refused(tmp_path):
    with pytest.raises(InputError, match="holds no store of a study"):
        contents(tmp_path)
