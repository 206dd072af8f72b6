"""Results of several machines in one store: every row once, or a sentence that says why not."""

import copy
import json
import os

import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.lab.study.problems.for_study import FOLDER
from quasistatic_ref.lab.study.report.report import study_report
from quasistatic_ref.lab.study.store.merge import merged, part_read
from quasistatic_ref.lab.study.store.store import Store, contents
from tests.lab.study import made_store, plain_report

SET = {"problems": {"sha256": "a"}}


def made(folder, seed, **fields):
    """A store of a machine; another seed gives other rows of the same measurements."""
    return made_store.written(folder, seed=seed, **SET | fields)


@pytest.fixture
def stores(tmp_path):
    """Two machines that ran the same study, and their rows."""
    both = {"fast": made(tmp_path / "fast", 3), "slow": made(tmp_path / "slow", 4)}
    return tmp_path, both


def parts(*folders):
    return [part_read(str(folder)) for folder in folders]


def without(row):
    return {name: value for name, value in row.items() if name != "machine"}


def key(row):
    return json.dumps(without(row), sort_keys=True)


def test_every_row_of_every_machine_is_there_once_with_its_machine(stores):
    folder, both = stores
    out = merged(parts(folder / "fast", folder / "slow"), folder / "all")
    rows = contents(out).rows
    assert len(rows) == sum(map(len, both.values()))
    for name, own in both.items():
        there = [without(row) for row in rows if row["machine"] == name]
        assert sorted(map(key, there)) == sorted(map(key, own))
    study = contents(out).study
    assert study["machines"] == ["fast", "slow"]
    assert study["machine"]["fast"] == {"processor": "slide rule"}


def test_machines_are_lines_of_tables_and_compared_on_the_same_problems(stores):
    """The report of the merged store against its rows: n problems of each machine, its median."""
    folder, _ = stores
    out = merged(parts(folder / "fast", folder / "slow"), folder / "all")
    rows = [row for row in contents(out).rows if row["repetition"] == 0]
    tables = plain_report.parsed(markdown_page(study_report(out)))
    (_, where, names, body) = next(t for t in tables if t[0].startswith("Setting mid"))
    assert names[:3] == ["solver", "interface", "machine"]
    assert len(body) == 2 * len(made_store.SOLVERS)
    for solver, interface, machine, calls, *_ in body:
        wanted = {"solver": solver, "interface": interface, "machine": machine}
        own = [r for r in plain_report.picked(rows, where) if wanted.items() <= r.items()]
        assert int(calls) == len(own) == 12
    (machines,) = (t for t in tables if t[0].startswith("Machines"))
    at = machines[2].index("time, median [ms], machine = slow")
    for way, setting, count, *_ in machines[3]:
        wanted = {"machine": "slow", "setting": setting, "warm": False, "units": "natural"}
        own = [r for r in rows if wanted.items() <= r.items()]
        own = [r for r in own if plain_report.said(r, "label") == way]
        assert int(count) == len(own)
        line = next(x for x in machines[3] if x[:2] == [way, setting])
        expected = plain_report.number("time, median [ms]", own, made_store.LIMIT)
        assert plain_report.agrees(line[at], expected)


def test_what_was_merged_is_merged_again_with_more(stores):
    folder, both = stores
    two = merged(parts(folder / "fast", folder / "slow"), folder / "two")
    third = made(folder / "third", 5)
    out = merged(parts(two, folder / "third"), folder / "three")
    assert len(contents(out).rows) == sum(map(len, both.values())) + len(third)
    assert contents(out).study["machines"] == ["fast", "slow", "third"]
    with pytest.raises(InputError, match="was merged already, of fast, slow"):
        part_read(f"name={two}")


def test_rows_are_never_counted_twice_under_whatever_name(stores):
    folder, _ = stores
    fast, slow = folder / "fast", folder / "slow"
    with pytest.raises(InputError, match="give each only once"):
        merged(parts(fast, f"copy={fast}"), folder / "out")
    main(["study", "pack", str(fast), "--out", str(folder / "short")])
    with pytest.raises(InputError, match="give each only once"):
        merged(parts(fast, folder / "short"), folder / "out")
    two = merged(parts(fast, slow), folder / "two")
    with pytest.raises(InputError, match="give each only once"):
        merged(parts(two, f"other={slow}"), folder / "out")
    with pytest.raises(InputError, match="where these are different machines"):
        merged(parts(f"one={fast}", f"one={slow}"), folder / "out")
    assert not (folder / "out").exists()


@pytest.mark.parametrize(("fields", "words"), [
    ({"problems": {"sha256": "b"}}, "another problems, by their hash"),
    ({"time_limit": 2.0}, "another time_limit"),
    ({"repetitions": 2}, "another repetitions"),
])  # fmt: skip
def test_results_of_another_study_are_refused_by_what_differs(stores, fields, words):
    folder, _ = stores
    made(folder / "other", 4, **fields)
    with pytest.raises(InputError, match=words):
        merged(parts(folder / "fast", folder / "other"), folder / "out")
    assert sorted(p.name for p in folder.iterdir()) == ["fast", "other", "slow"]


def test_other_options_of_a_solver_are_refused(stores):
    folder, _ = stores
    solvers = copy.deepcopy(made_store.STUDY["solvers"])
    solvers[0]["options"]["mid"] = {"eps": 1.0}
    made(folder / "other", 4, solvers=solvers)
    with pytest.raises(InputError, match="another solver or options qpsolvers:ant than"):
        merged(parts(folder / "fast", folder / "other"), folder / "out")


def test_a_folder_that_cannot_be_merged_is_refused(tmp_path):
    with Store(tmp_path, made_store.STUDY | SET):
        pass
    with pytest.raises(InputError, match="holds no rows yet"):
        part_read(str(tmp_path))
    made(tmp_path / "unsaid", 3, problems={})
    with pytest.raises(InputError, match="does not say which problems"):
        part_read(str(tmp_path / "unsaid"))


def test_a_sweep_is_refused(tmp_path):
    made_store.sweep_written(tmp_path / "sweep")
    with pytest.raises(InputError, match="holds a sweep"):
        part_read(str(tmp_path / "sweep"))


def test_a_store_is_written_whole_or_not_at_all(stores, monkeypatch):
    """The rename that ends the writing fails, as where the disk is full; nothing is left."""
    folder, _ = stores
    both = parts(folder / "fast", folder / "slow")

    def full(*_):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr("pathlib.Path.rename", full)
        with pytest.raises(InputError, match="No space left"):
            merged(both, folder / "out")
    assert sorted(os.listdir(folder)) == ["fast", "slow"]
    merged(both, folder / "out")
    with pytest.raises(InputError, match="is there already"):
        merged(both, folder / "out")


def test_runs_on_two_machines_are_merged_by_the_command_and_not_continued(whole, tmp_path, capsys):
    two = made_store.of_another_machine(whole, tmp_path / "two")
    out = tmp_path / "both"
    assert main(["study", "merge", f"one={whole}", str(two), "--out", str(out)]) == 0
    assert "rows of 2 machines" in capsys.readouterr().out
    assert len(set_read(out / FOLDER)) == 5
    assert len(contents(out).rows) == 2 * len(contents(whole).rows)
    assert "daqp | qpsolvers | two" in markdown_page(study_report(out))
    with pytest.raises(InputError, match="holds merged results"):
        Store(out, contents(whole).study)
