"""A study from its file to its rows: complete, and the same however often it was stopped."""

import os
import signal
import subprocess
import sys
import time
from collections import Counter
from dataclasses import fields, replace
from pathlib import Path

import dask
import distributed
import duckdb
import pandas
import pytest

import quasistatic_ref
from quasistatic_ref import InputError
from quasistatic_ref.lab.study.row import Row, key_of
from quasistatic_ref.lab.study.run import measured
from quasistatic_ref.lab.study.store import ROWS, rows_read

ROOT = str(Path(quasistatic_ref.__file__).parents[1])
CALLS = 3 * (2 + 1) * 2
"""Three problems, to a solver at two settings and to a function at one, in two units."""
MEASURED = ("seconds", "seconds_low", "seconds_high", "seconds_first", "seconds_solver",
            "seconds_setup", "memory")  # fmt: skip


def has_ended(pid):
    """Whether a process is not there, or waits to be forgotten by its parent."""
    stat = Path(f"/proc/{pid}/stat")
    return not stat.exists() or stat.read_text().rpartition(")")[2].split()[0] == "Z"


def facts(rows):
    """What two runs of a study have in common."""
    return sorted(str(replace(row, **dict.fromkeys(MEASURED))) for row in rows)


def test_every_measurement_is_a_row_once_and_libraries_read_them(whole):
    rows, store = whole
    assert len(rows) == len({key_of(row) for row in rows}) == CALLS
    assert {row.outcome for row in rows} <= {"solved", "failed"}
    natural = [row for row in rows if row.units == "natural" and row.solver == "mine"]
    assert all(row.digits > 5 and not row.false_claim for row in natural)
    assert all(0 < row.seconds_low <= row.seconds <= row.seconds_high for row in rows)
    table = pandas.read_parquet(store / ROWS)
    assert list(table.columns) == [field.name for field in fields(Row)]
    assert table["seconds"].tolist() == [row.seconds for row in rows]
    question = f"SELECT problem FROM '{store / ROWS}' WHERE digits >= 6"
    answer = [row.problem for row in rows if (row.digits or 0) >= 6]
    assert [name for (name,) in duckdb.sql(question).fetchall()] == answer


def test_a_study_that_was_stopped_goes_on_and_measures_nothing_twice(
    run, small, whole, monkeypatch, tmp_path
):
    def stopped(*arguments):
        for count, row in enumerate(measured(*arguments)):
            if count == 7:
                raise KeyboardInterrupt
            yield row

    with monkeypatch.context() as patched:
        patched.setattr("quasistatic_ref.lab.study.run.measured", stopped)
        with pytest.raises(KeyboardInterrupt):
            run(small, "stopped")
    before = rows_read(tmp_path / "stopped")
    assert len(before) == 7
    rows = run(small, "stopped")
    assert rows[:7] == before
    assert facts(rows) == facts(whole[0])
    assert run(small, "stopped") == rows
    with pytest.raises(InputError, match="holds another study, of other problems or limits"):
        run(small.replace("mass_ratio = 2", "mass_ratio = 1"), "stopped")


def test_ctrl_c_ends_the_command_with_130_and_says_that_it_goes_on(study, small, tmp_path):
    """While a function sleeps in its process: whatever it started has ended, too."""
    study(small.replace("honest", "sleeps"))
    # Where this was started in the background, SIGINT is ignored, also by what it starts.
    program = (
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
        "from quasistatic_ref.cli.main import main; "
        "raise SystemExit(main(['study', 'run', 'study.toml']))"
    )
    command = [sys.executable, "-c", program]
    process = subprocess.Popen(
        command, cwd=tmp_path, env=os.environ | {"PYTHONPATH": ROOT}, stderr=subprocess.PIPE
    )
    child = tmp_path / "child"
    while not (child.exists() and child.read_text()):
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    said = process.communicate()[1].decode()
    assert process.returncode == 130
    assert "what was measured is in study; the same command goes on from there" in said
    assert has_ended(int(child.read_text()))
    assert len(rows_read(tmp_path / "study")) == CALLS - 3 * 2  # those of the other solver


LIMITED = """
time_limit = 0.3
warm_up = 3.0
memory = 0.3
budget = 3.0
repetitions = 1
[problems]
set = "contact-qp"
families = { contacts = { count = 2, most = 12 } }
[solvers]
sleeps.function = "solvers.py:sleeps"
eats.function = "solvers.py:eats"
exits.function = "solvers.py:exits"
honest.function = "solvers.py:honest"
[[runs]]
solvers = ["sleeps", "eats", "exits", "honest"]
"""


def test_a_solver_that_exceeds_its_limits_is_ended_and_costs_itself_only(run, tmp_path):
    """One sleeps, and so does what it starts; one takes memory; one ends its process."""
    rows = run(LIMITED)
    outcomes = {row.solver: [] for row in rows}
    for row in rows:
        outcomes[row.solver].append(row.outcome)
    assert outcomes["sleeps"] == ["timeout", "not run"]  # a call takes longer than the budget
    assert outcomes["eats"][0] == "out of memory"
    assert outcomes["exits"][0] == "crashed"
    assert outcomes["honest"] == ["solved"] * 2
    assert has_ended(int((tmp_path / "child").read_text()))
    assert "ended with 7" in {row.status for row in rows if row.solver == "exits"}


def test_on_a_cluster_the_rows_are_the_same(run, small, whole, tmp_path):
    """Its worker is a daemon, which may start no process of multiprocessing."""
    with dask.config.set(temporary_directory=str(tmp_path)), distributed.LocalCluster(
        n_workers=1, threads_per_worker=2, dashboard_address=None
    ) as cluster:  # fmt: skip
        there = run(small, "there", scheduler=cluster.scheduler_address)
    assert facts(there) == facts(whole[0])


ORDERED = """
repetitions = 1
[problems]
set = "contact-qp"
families.moving = { count = 12, most = 1 }
[solvers.mine]
function = "solvers.py:warm"
[[runs]]
solvers = ["qpsolvers:osqp", "qpsolvers:piqp", "cvxpy:osqp", "mine"]
starts = ["cold", "warm"]
"""


def test_steps_in_order_start_from_the_step_before_and_only_where_a_start_is_used(run):
    """The function says "again" where it starts from the very answer to this step: never."""
    rows = run(ORDERED)
    counts = Counter((row.door, row.solver, row.start) for row in rows)
    assert counts == {
        ("qpsolvers", "osqp", "cold"): 12, ("qpsolvers", "osqp", "warm"): 12,
        ("qpsolvers", "piqp", "cold"): 12, ("cvxpy", "osqp", "cold"): 12,
        ("function", "mine", "cold"): 12, ("function", "mine", "warm"): 12,
    }  # fmt: skip
    warm = [row for row in rows if row.start == "warm" and row.solver == "mine"]
    assert [row.started for row in warm] == [False] + [True] * 11
    assert {row.status for row in warm} == {"optimal"}


def test_problems_alone_start_from_a_neighbour(run):
    text = ORDERED.replace("families.moving = { count = 12, most = 1 }", "families.gaps = 2")
    rows = [row for row in run(text) if row.start == "warm"]
    assert {(row.door, row.solver) for row in rows} == {
        ("qpsolvers", "osqp"), ("cvxpy", "osqp"), ("function", "mine")}  # fmt: skip
    assert all(row.started for row in rows)
