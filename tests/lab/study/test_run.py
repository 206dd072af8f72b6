"""A study from its call to its rows: complete, and the same however often it was stopped."""

import os
import signal
from dataclasses import fields, replace
from pathlib import Path

import pandas
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.lock import locked
from quasistatic_ref.lab.study.row import Row, key_of
from tests.lab.study import broken
from tests.lab.study.asked import (
    ROWS,
    Limits,
    measured,
    problems_taken,
    rows_read,
    rows_written,
    study,
)
from tests.pages import ROOT
from tests.processes import has_ended, python, started, waited_for

CALLS = 3 * (2 + 1) * 2
"""Three problems, to a solver at two settings and to a function at one, in two units."""


def facts(rows):
    """What two runs of a study have in common."""
    return sorted(str(replace(row, seconds=None)) for row in rows)


def test_every_measurement_is_a_row_once_and_libraries_read_them(whole):
    rows, store = whole
    assert len(rows) == len({key_of(row) for row in rows}) == CALLS
    assert {row.says for row in rows} <= {"solved", "other"}
    assert all(row.digits > 5 for row in rows if row.units == "natural" and row.solver == "mine")
    assert all(row.seconds > 0 for row in rows)
    table = pandas.read_parquet(store / ROWS)
    assert list(table.columns) == [field.name for field in fields(Row)]
    assert table["seconds"].tolist() == [row.seconds for row in rows]


def test_rows_that_stand_twice_count_once(whole, tmp_path, cli):
    rows, store = whole
    assert rows_read(rows_written(tmp_path / ROWS, [*rows, rows[0], rows[0]]).parent) == rows
    said = [cli("study report", *folders, "--out", tmp_path / "report") and
            (tmp_path / "report" / "summary.md").read_text()
            for folders in ([store], [store, tmp_path])]  # fmt: skip
    assert said[0] == said[1]


@pytest.mark.usefixtures("in_this_process")
def test_a_study_that_was_stopped_goes_on_and_measures_nothing_twice(
    small, whole, monkeypatch, tmp_path
):
    def stopped(*arguments):
        for count, row in enumerate(measured(*arguments)):
            if count == 7:
                raise KeyboardInterrupt
            yield row

    with monkeypatch.context() as patched:
        patched.setattr("quasistatic_ref.lab.study.run.measured", stopped)
        with pytest.raises(KeyboardInterrupt):
            small(tmp_path)
    before = rows_read(tmp_path)
    assert len(before) == 7
    rows = small(tmp_path)
    assert rows[:7] == before
    assert facts(rows) == facts(whole[0])
    assert small(tmp_path) == rows


@pytest.mark.usefixtures("in_this_process")
def test_a_folder_takes_other_problems_and_no_others_of_the_same_names(three, tmp_path):
    def of(problems, **limits):
        return study(problems, [broken.denies], folder=tmp_path, limits=Limits(**limits))

    first = of(three[:2])
    assert len(of(three[2:])) == 3
    assert rows_read(tmp_path)[:2] == first
    changed = replace(three[0], g=2 * three[0].g)
    for problems, limits in (([changed], {}), (three, {"budget": 1.0})):
        with pytest.raises(InputError, match="holds another study, of other problems or limits"):
            of(problems, **limits)


@pytest.mark.usefixtures("in_this_process")
def test_two_studies_at_once_in_one_folder_lose_no_rows(three, tmp_path):
    def of(solver):
        return study(three, [solver], folder=tmp_path)

    with (
        locked(tmp_path),
        pytest.raises(InputError, match="is being written by another process"),
    ):
        of(broken.denies)
    of(broken.denies)
    assert len(of(broken.gives_up)) == len(rows_read(tmp_path)) == 2 * len(three)


def test_ctrl_c_ends_the_command_with_130_and_says_that_it_goes_on(monkeypatch, tmp_path, cli):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("quasistatic_ref.lab.study.default.study", interrupted)
    said = cli("study run --quick --out", tmp_path, status=130).err
    assert f"what was measured is in {tmp_path}; the same command goes on from there" in said


HANGS = """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in what stands in the background
from quasistatic_ref.lab.study.run import Limits, study
from tests.lab.study.broken import sleeps
limits = Limits(time_limit=600.0, warm_up=600.0)
study({"gaps": 1}, ["qpsolvers:daqp", sleeps], folder="store", limits=limits)
"""


@pytest.mark.parametrize(
    "end", [pytest.param(signal.SIGINT, marks=pytest.mark.long), signal.SIGKILL]
)
def test_a_solver_and_what_it_starts_end_with_the_process_of_the_study(end, tmp_path):
    child = tmp_path / "child"
    process = started(HANGS, tmp_path, CHILD=str(child))
    waited_for(lambda: child.exists() and child.read_text())
    process.send_signal(end)
    process.wait()
    waited_for(lambda: has_ended(int(child.read_text())))
    if end == signal.SIGINT:
        assert [row.solver for row in rows_read(tmp_path / "store")] == ["daqp"]


SIX_LINES = """
from quasistatic_ref.lab.study.run import study
from quasistatic_ref.lab.sweep import simulate_many
def solve(P, q, G, h):
    return None, None, "infeasible"
study({"gaps": 1}, [solve], folder="store")
simulate_many("block_incline", {"steps": [1, 2]}, "map", workers=2)
"""


@pytest.mark.long  # processes of two kinds, as those of other tests
def test_a_script_needs_no_guard_against_processes_that_import_it(tmp_path):
    (tmp_path / "script.py").write_text(SIX_LINES)
    python("script.py", cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(ROOT)})
    assert [row.solver for row in rows_read(tmp_path / "store")] == ["solve"]
    assert len(list((tmp_path / "map" / "runs").iterdir())) == 2


def limited(folder, executor=None):
    """Words about one that sleeps, on two problems; those about others are as they are alone."""
    problems = problems_taken({"gaps": 2})
    short = Limits(warm_up=3.0, budget=1.0)
    others = Limits(time_limit=30.0, warm_up=30.0, memory=0.3e9, repetitions=1)
    rows = []
    for limits, solvers in (
        (short, [broken.sleeps]),
        (others, [broken.eats, broken.exits, broken.spoils]),
    ):
        store = folder / solvers[0].__name__
        rows += study(problems, solvers, folder=store, executor=executor, limits=limits)
    words = {row.solver: [one.status for one in rows if one.solver == row.solver] for row in rows}
    assert [word.endswith("bytes, and was ended") for word in words["eats"]] == [True] * 2
    assert words["exits"] == ["ended with 7"] * 2
    assert words["spoils"] == ["optimal"] * 2
    assert has_ended(int(Path(os.environ["CHILD"]).read_text()))
    return [word.endswith(" s, and was ended") for word in words["sleeps"]]


@pytest.fixture
def child(tmp_path, monkeypatch):
    """Where the solver that sleeps writes the id of what it starts; workers inherit it."""
    monkeypatch.setenv("CHILD", str(tmp_path / "child"))


@pytest.mark.usefixtures("child")
def test_a_solver_that_exceeds_its_limits_is_ended_and_costs_itself_only(tmp_path):
    """One sleeps, and so does what it starts; others take memory, end, print."""
    assert limited(tmp_path) == [True]  # a call takes longer than the budget: no second one


@pytest.mark.long
@pytest.mark.usefixtures("child")  # before the workers start
def test_on_two_workers_of_dask_the_rows_are_the_same_and_limits_hold(
    small, whole, two_of_dask, tmp_path
):
    """Its workers are daemons, which may start no process of multiprocessing."""
    assert facts(small(tmp_path / "there", two_of_dask)) == facts(whole[0])
    assert limited(tmp_path, two_of_dask) == [True] * 2
