"""A study from its file to its table: complete, the same however often it was interrupted."""

import json
import os
import pty
import random
import re
import signal
import sqlite3
import subprocess
import sys
import time
import warnings
from contextlib import closing
from pathlib import Path

import distributed
import pytest

import quasistatic_ref
from quasistatic_ref.formats.files import toml_read
from quasistatic_ref.lab.study.file.study_file import solver_study
from quasistatic_ref.lab.study.measuring.run import run_study
from quasistatic_ref.lab.study.store.rows import table
from quasistatic_ref.lab.study.store.store import STORE, contents

SMALL = """
time_limit = 20.0
[problems]
families = { contacts = 4, mass_ratio = 3 }
[[runs]]
solvers = ["qpsolvers:daqp", "qpsolvers:clarabel"]
settings = ["default", "high"]
units = ["raw", "natural"]
"""
CALLS = (4 + 3 + 1) * 2 * 2 * 2
"""One problem of ten is run again."""


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The folder of the small study, run once without interruption; tests leave it as it is."""
    folder = tmp_path_factory.mktemp("whole")
    path = folder / "study.toml"
    path.write_text('format = "quasistatic-ref/study"\nversion = 1\n' + SMALL)
    run_study(solver_study(path, toml_read(path)), folder / "store", progress=False)
    return folder / "store"


def test_every_measurement_of_the_plan_is_in_the_table_once(whole):
    rows = contents(whole).rows
    assert len(rows) == len({json.dumps(r) for r in table(rows)}) == CALLS
    assert {r["outcome"] for r in rows} <= {"solved", "failed"}
    there = contents(whole).study
    assert there["problems"]["count"] == there["problems"]["exact"] == 7
    assert {"clarabel", "daqp", "qpsolvers", "numpy"} <= set(there["versions"])


def test_an_active_set_solver_in_natural_units_has_nearly_all_digits(whole):
    rows = [r for r in contents(whole).rows if r["solver"] == "daqp" and r["units"] == "natural"]
    found = [r["digits"]["delta_q"] for r in rows if r["setting"] == "high"]
    assert len(found) == 7 + 1
    assert min(found) > 9


def on_a_terminal(words, until, seconds=120.0):
    """What a command prints on a terminal that does not know its width, and its exit status.

    Ctrl-C is pressed where something that matches `until` has been printed.
    """
    with warnings.catch_warnings():
        # JAX, which another test may have imported, warns of every fork; this one only calls exec.
        warnings.simplefilter("ignore", RuntimeWarning)
        process, terminal = pty.fork()
    if process == 0:
        # As a shell gives a terminal: a job in the background inherits that Ctrl-C is ignored.
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.execv(words[0], words)
    printed, end, pressed = "", time.monotonic() + seconds, False
    while time.monotonic() < end:
        try:
            new = os.read(terminal, 4096).decode(errors="replace")
        except OSError:  # the other end is closed
            break
        printed += new
        if until is not None and re.search(until, printed) and not pressed:
            os.write(terminal, b"\x03")
            pressed = True
    return printed, os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])


HARVESTED = """
time_limit = 20.0
[problems]
scenarios = ["block_push"]
families = { scenarios = 3 }
[[runs]]
solvers = ["qpsolvers:daqp"]
"""


def test_the_making_of_problems_is_shown_and_may_be_interrupted(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text('format = "quasistatic-ref/study"\nversion = 1\n' + HARVESTED)
    estimate = r"exact answers: .*\d+/\d+ \[\d\d:\d\d<\d\d:\d\d"
    printed, status = on_a_terminal(command(path, tmp_path / "store"), estimate)
    assert re.search(estimate, printed)
    assert status == 130
    assert "interrupted; what was measured is in" in printed
    assert printed.index("loads solvers") < printed.index("exact answers")
    quiet, status = on_a_terminal([*command(path, tmp_path / "store"), "--quiet"], None)
    assert "exact answers" not in quiet
    assert "calls made" not in quiet
    assert status == 0
    assert len(contents(tmp_path / "store").rows) == 3 + 1  # one is run again


def command(path, store):
    return [sys.executable, "-m", "quasistatic_ref.cli.main", "study", "run", str(path),
            "--out", str(store)]  # fmt: skip


def lines(store):
    try:
        with closing(sqlite3.connect(f"file:{store / STORE}?mode=ro", uri=True)) as tables:
            return tables.execute("SELECT count(*) FROM rows").fetchone()[0]
    except sqlite3.Error:  # not there yet
        return 0


def test_a_study_killed_at_random_moments_gives_the_same_table(study, run, whole, tmp_path):
    path, store = study(SMALL).path, tmp_path / "killed"
    root = str(Path(quasistatic_ref.__file__).parents[1])
    environment = os.environ | {"PYTHONPATH": root}
    chosen = random.Random().sample(range(1, CALLS - 8), 2)
    for moment in sorted(chosen):
        process = subprocess.Popen(
            command(path, store), env=environment, stdout=subprocess.DEVNULL, cwd=tmp_path
        )
        while lines(store) < moment and process.poll() is None:
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
        process.wait()
        assert lines(store) >= moment
    before = contents(store).rows
    assert len(before) < CALLS, f"killed at {chosen}, the study was over already"
    rows = run(SMALL, "killed")
    assert table(rows) == table(contents(whole).rows), f"killed at {chosen}"
    kept = [r for r in rows if r in before]  # nothing is measured twice: times are the old ones
    assert len(kept) == len(before)


def test_a_finished_study_measures_nothing_again(study, whole):
    before = contents(whole).rows
    run_study(study(SMALL), whole, progress=False)
    assert contents(whole).rows == before


PLANTED = """
time_limit = 0.3
warm_up = 2.0
repetitions = 2
budget = {budget}
[problems]
families = {{ contacts = 4 }}
[solvers.loops]
callable = "planted_solvers:loops"
[solvers.honest]
callable = "planted_solvers:honest"
[[runs]]
solvers = ["loops", "honest"]
again = 0
units = ["raw", "natural"]
"""


def test_what_a_budget_does_not_reach_is_said_also_after_an_interruption(run, tmp_path):
    text = PLANTED.format(budget=4.0)
    rows = run(text)
    outcomes = {n: [r["outcome"] for r in rows if r["solver"] == n] for n in ("loops", "honest")}
    assert len(outcomes["loops"]) == len(outcomes["honest"]) == 4 * 2
    # a call that warms it up takes 2 s and more: after two the budget is used up
    assert 1 <= outcomes["loops"].count("timeout") <= 2
    assert set(outcomes["loops"]) == {"timeout", "not_run_budget"}
    assert outcomes["honest"][0] == "solved"  # one solver's budget is not another's

    with closing(sqlite3.connect(tmp_path / "store" / STORE)) as tables, tables:
        tables.execute("DELETE FROM rows WHERE outcome = 'not_run_budget'")
    assert table(run(text)) == table(rows)


def test_on_a_cluster_of_two_workers_the_results_are_the_same(run, whole):
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster:
        there = run(SMALL, "there", scheduler=cluster.scheduler_address)
    assert table(there) == table(contents(whole).rows)
