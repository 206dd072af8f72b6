"""A study from its file to its table: complete, the same however often it was interrupted."""

import json
import os
import random
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path

import dask
import distributed

import quasistatic_ref
from quasistatic_ref.cli.main import main
from quasistatic_ref.lab.study.problems import making
from quasistatic_ref.lab.study.store.rows import table
from quasistatic_ref.lab.study.store.store import STORE, contents

CALLS = (5 + 1) * (2 + 1) * 2
"""One problem of five is run again; a solver at two settings and one at one; in two units."""


def test_every_measurement_of_the_plan_is_in_the_table_once(whole):
    rows = contents(whole).rows
    assert len(rows) == len({json.dumps(r) for r in table(rows)}) == CALLS
    assert {r["outcome"] for r in rows} <= {"solved", "failed"}
    there = contents(whole).study
    assert there["problems"]["count"] == there["problems"]["exact"] == 5
    assert {"daqp", "qpsolvers", "numpy"} <= set(there["versions"])


HARVESTED = """
time_limit = 20.0
[problems]
scenarios = ["block_push"]
families = { scenarios = 3 }
[[runs]]
solvers = ["qpsolvers:daqp"]
"""


def test_the_making_of_problems_may_be_interrupted(tmp_path, monkeypatch, capsys, cli):
    path = tmp_path / "study.toml"
    store = tmp_path / "store"
    path.write_text('format = "quasistatic-ref/study"\nversion = 1\n' + HARVESTED)

    def interrupted(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(making, "exact_answer", interrupted)
        assert main(command(path, store)[3:]) == 130
    assert "interrupted; what was measured is in" in capsys.readouterr().err
    assert cli(*command(path, store)[3:], "--quiet").err == ""
    assert len(contents(store).rows) == 3 + 1  # one is run again


def command(path, store):
    return [sys.executable, "-m", "quasistatic_ref", "study", "run", str(path),
            "--out", str(store)]  # fmt: skip


def lines(store):
    try:
        with closing(sqlite3.connect(f"file:{store / STORE}?mode=ro", uri=True)) as tables:
            return tables.execute("SELECT count(*) FROM rows").fetchone()[0]
    except sqlite3.Error:  # not there yet
        return 0


def test_a_study_killed_at_a_random_moment_gives_the_same_table(study, run, small, whole, tmp_path):
    path = study(small).path
    store = tmp_path / "killed"
    root = str(Path(quasistatic_ref.__file__).parents[1])
    moment = random.Random().randrange(1, CALLS - 8)
    process = subprocess.Popen(
        command(path, store), env=os.environ | {"PYTHONPATH": root}, stdout=subprocess.DEVNULL,
        cwd=tmp_path,
    )  # fmt: skip
    while lines(store) < moment and process.poll() is None:
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    process.wait()
    before = contents(store).rows
    assert moment <= len(before) < CALLS, f"killed at {moment}"
    rows = run(small, "killed")
    assert table(rows) == table(contents(whole).rows), f"killed at {moment}"
    kept = [r for r in rows if r in before]  # nothing is measured twice: times are the old ones
    assert len(kept) == len(before)


MIXED = """
time_limit = 0.3
warm_up = 1.0
budget = 5.0
repetitions = 2
[problems]
set = "contact-qp"
families = { contacts = { count = 5, most = 12 } }
[solvers.slow]
callable = "planted_solvers:slow"
[solvers.missing]
callable = "no_such_module:solve"
[solvers.honest]
callable = "planted_solvers:honest"
[[runs]]
solvers = ["slow", "missing", "honest"]
again = 0
"""


def test_bad_solvers_cost_themselves_only_and_a_budget_stays_used_up(run, tmp_path):
    """One takes 1.5 s of warm-up a problem and its start, so that four exceed 5 s; one is none."""
    rows = run(MIXED)
    outcomes = {n: [r["outcome"] for r in rows if r["solver"] == n] for n in ("slow", "honest")}
    assert len(outcomes["slow"]) == len(outcomes["honest"]) == len(rows) / 2 == 5
    assert set(outcomes["slow"]) == {"timeout", "not_run_budget"}
    assert outcomes["honest"][0] == "solved"  # one solver's budget is not another's
    (reason,) = contents(tmp_path / "store").unreached.values()
    assert "cannot be imported" in reason
    with closing(sqlite3.connect(tmp_path / "store" / STORE)) as tables, tables:
        tables.execute("DELETE FROM rows WHERE outcome = 'not_run_budget'")
    assert table(run(MIXED)) == table(rows)


def test_on_a_cluster_of_two_workers_the_results_are_the_same(run, small, whole, tmp_path):
    """The workers are threads of this process: what goes to and fro is pickled all the same."""
    with dask.config.set(temporary_directory=str(tmp_path)), distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=False, protocol="tcp://",
        dashboard_address=None,
    ) as cluster:  # fmt: skip
        there = run(small, "there", scheduler=cluster.scheduler_address)
    assert table(there) == table(contents(whole).rows)
