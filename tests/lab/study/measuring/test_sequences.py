"""Sequences solved in order: what each solver starts from, and modes that are not possible."""

import json
from pathlib import Path

import numpy as np
import pytest

from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.study.calling import sessions
from quasistatic_ref.lab.study.measuring.ask import solver_named
from quasistatic_ref.lab.study.report.report import study_report
from quasistatic_ref.lab.study.store.rows import label_of, table
from quasistatic_ref.lab.study.store.store import contents

CALLABLES = '''
import json
import time

import numpy as np
import quadprog


def solved(P, q, G, h):
    x, _, _, _, lam, _ = quadprog.solve_qp(P, -q, -G.T, -h)
    return x, lam

def warm(P, q, G, h, start=None):
    x, lam = solved(P, q, G, h)
    with open("starts.jsonl", "a") as file:
        said = [None if start is None else start[0].tolist(), x.tolist()]
        file.write(json.dumps(said) + chr(10))
    return x, lam

def counted(state=[0]):
    state[0] += 1
    return state[0]

def hangs(P, q, G, h):
    """Its sixth call never ends; after each start it is right five times."""
    while counted() > 5:
        time.sleep(1)
    return solved(P, q, G, h)

def late(P, q, G, h, before=[]):
    before.append(solved(P, q, G, h))
    return before[max(len(before) - 2, 0)]
'''


@pytest.fixture
def own(tmp_path, monkeypatch):
    (tmp_path / "sequence_solvers.py").write_text(CALLABLES)
    monkeypatch.chdir(tmp_path)
    return "sequence_solvers"


def of(rows, name):
    return [row for row in rows if row["solver"] == name]


@pytest.mark.parametrize(("solver", "modes"), [
    ("qpsolvers:osqp", ("cold", "primal")), ("qpsolvers:piqp", ("cold",)),
])  # fmt: skip
def test_what_a_solver_can_start_from_is_a_fact_of_its_interface(solver, modes):
    assert sessions.modes_of(solver_named(solver)) == modes


ORDERED = """
repetitions = 1
{limits}
[problems]
set = "contact-qp"
families.moving = {{ count = 12, most = {stride} }}
[solvers.own]
callable = "sequence_solvers:{own}"
options.high = {{}}
[[runs]]
solvers = [{solvers}]
settings = ["high"]
modes = ["cold", "primal", "primal-dual"]
"""


def test_solvers_keep_their_digits_in_every_mode_and_a_callable_starts_from_its_answer(own, run):
    """12 steps in 2 modes of each; the callable writes down what it was given and returned."""
    listed = '"qpsolvers:daqp", "qpsolvers:osqp", "own"'
    rows = run(ORDERED.format(limits="", stride=1, own="warm", solvers=listed))
    assert len(rows) == 12 * (2 + 2 + 2)
    assert all(row["digits"]["delta_q"] > 4 for row in [*of(rows, "daqp"), *of(rows, "own")])
    assert sum(row["outcome"] == "solved" for row in of(rows, "osqp")) > 20
    starts = [json.loads(line) for line in Path("starts.jsonl").read_text().splitlines()]
    warm = [one for one in starts if one[0] is not None]
    assert len(warm) == 11
    for start, _ in warm:
        np.testing.assert_array_equal(start, starts[starts.index([start, _]) - 1][1])


def test_a_solver_that_hangs_costs_itself_only(own, run):
    """After each start of its process it is right five times: of 12 steps 10, 2 ended; cold."""
    limits = "time_limit = 0.5\nwarm_up = 0.5"
    rows = run(ORDERED.format(limits=limits, stride=1, own="hangs", solvers='"own"'))
    assert {row["mode"] for row in rows} == {"cold"}  # it takes no start
    ends = sorted(rows, key=lambda row: row["problem"])
    assert [row["outcome"] for row in ends] == [*["solved"] * 5, "timeout"] * 2
    for row in ends:
        solved = row["outcome"] == "solved"
        assert row["digits"]["delta_q"] > 12 if solved else "killed after 0.5 s" in row["claimed"]


def test_a_solver_that_returns_its_last_answer_again_is_named(own, run, tmp_path):
    """It solves each step after it has answered with what it found before."""
    rows = run(ORDERED.format(limits="", stride=16, own="late", solvers='"own", "qpsolvers:daqp"'))
    assert any(row["repeats"] for row in of(rows, "own"))
    assert not any(row["repeats"] for row in of(rows, "daqp"))
    page = markdown_page(study_report(tmp_path / "store"))
    assert page.count("looks as if it") == 1
    assert "callable:own (cold) looks as if it returns its last answer again." in page


STUDY = """
repetitions = 1
[problems]
set = "contact-qp"
families = { moving = 12 }
[[runs]]
solvers = ["qpsolvers:daqp"]
settings = ["high"]
modes = ["cold", "primal"]
"""


def test_a_study_has_sequences_in_its_store_resumes_and_reports_them(run, tmp_path):
    rows = run(STUDY)
    assert [label_of(row) for row in rows] == ["qpsolvers:daqp"] * 24
    assert table(run(STUDY)) == table(contents(tmp_path / "store").rows) == table(rows)
    assert contents(tmp_path / "store").rows == sorted(rows, key=lambda row: (
        row["problem"], row["mode"]))  # fmt: skip
    page = markdown_page(study_report(tmp_path / "store"))
    assert "| qpsolvers:daqp | high | natural | primal | 11 |" in page
