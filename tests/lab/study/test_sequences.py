"""Sequences solved in order: what each solver starts from, and modes that are not possible."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.commands import study_sequences
from quasistatic_ref.lab.study.measuring import sequences
from quasistatic_ref.lab.study.measuring.keeper import EXTRA
from quasistatic_ref.lab.study.measuring.sequences import (
    SolverLimits,
    checked,
    in_one_unit,
    modes_of,
    sequence_rows,
)

ONCE = SolverLimits(repetitions=1)
CALLABLES = '''
import json
import os
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

def hangs(P, q, G, h, start=None):
    """Its third call never ends; after each start it is right twice."""
    while counted() > 2:
        pass
    return solved(P, q, G, h)

def eats(P, q, G, h):
    held = []
    while counted() > 2:
        held.append(np.ones(10**6))
        time.sleep(1e-3)
    return solved(P, q, G, h)

def dies(P, q, G, h):
    if counted() > 2:
        os._exit(3)
    return solved(P, q, G, h)

def stops_the_clock(P, q, G, h):
    """Right, after 5 ms of which its process knows nothing."""
    import __main__

    __main__.perf_counter = lambda: 0.0
    end = time.process_time() + 5e-3
    while time.process_time() < end:
        pass
    return solved(P, q, G, h)

def broken(P, q, G, h):
    raise RuntimeError("no")
'''


@pytest.fixture
def grasp(members):
    """Two sequences, in order."""
    own = [one for one in members if one.facts["sequence"]]
    return {name: [one for one in own if one.facts["sequence"]["name"] == name]
            for name in ("bunny_grasp/0", "stack/0")}  # fmt: skip


@pytest.fixture
def own(tmp_path, monkeypatch):
    (tmp_path / "sequence_solvers.py").write_text(CALLABLES)
    monkeypatch.chdir(tmp_path)
    return "sequence_solvers"


def test_every_mode_is_that_of_the_command():
    assert study_sequences.MODES == sequences.MODES


def test_what_a_solver_can_start_from_is_a_fact_of_its_interface(own):
    assert modes_of("daqp") == ("cold", "updates", "active set")
    assert modes_of("osqp") == ("cold", "updates", "primal-dual")
    assert modes_of("clarabel") == modes_of("piqp") == ("cold", "updates")
    assert modes_of("quadprog") == modes_of(f"{own}:solved") == ("cold",)
    assert modes_of("qpsolvers:osqp") == ("cold", "primal")
    assert modes_of(f"{own}:warm") == ("cold", "primal-dual")


@pytest.mark.parametrize(("solver", "mode"), [
    ("clarabel", "primal-dual"), ("quadprog", "updates"), ("daqp", "primal"),
    ("sequence_solvers:solved", "primal-dual"),
])  # fmt: skip
def test_a_mode_that_a_solver_does_not_have_is_an_error(solver, mode, own, capsys):
    with pytest.raises(InputError, match=f"is no mode of {solver}"):
        checked([solver], ["cold", mode])
    assert main(["study", "sequences", solver, "--modes", mode]) == 2
    assert "is no mode of" in capsys.readouterr().err


@pytest.mark.parametrize(("more", "words"), [
    (["nobody"], "is none of"),
    (["qpsolvers:nobody"], "is not a solver that qpsolvers reaches here"),
    (["daqp", "--modes", "hot"], "is none of cold"),
    (["daqp", "--scenario", "nowhere"], "have no such sequence"),
    (["daqp", "--repetitions", "0"], "must be at least 1"),
    (["daqp", "--accuracy", "2"], "must be between 0 and 1"),
    (["daqp", "--time-limit", "0"], "--time-limit: must be above 0"),
    (["daqp", "--memory", "nan"], "--memory: must be above 0"),
])  # fmt: skip
def test_what_cannot_be_run_is_refused(more, words, capsys):
    assert main(["study", "sequences", *more]) == 2
    assert words in capsys.readouterr().err


def test_a_sequence_has_one_system_of_units_and_the_same_answers(grasp):
    forms, answers = in_one_unit(grasp["bunny_grasp/0"])
    for form, x in zip(forms, answers, strict=True):
        slack, size = form.A @ x - form.b, np.abs(form.A) @ np.abs(x) + np.abs(form.b)
        assert slack.min() >= -1e-14 * size.max()
    H = [form.H for form in forms]
    assert all(np.allclose(np.diag(one), np.diag(H[0]), rtol=0.1) for one in H)


def test_solvers_keep_their_digits_in_every_mode(grasp):
    modes = checked(["daqp", "osqp", "clarabel", "qpsolvers:daqp"], None)
    rows = list(sequence_rows(grasp, modes, 1e-9, ONCE))
    assert len(rows) == 24 * sum(map(len, modes.values()))
    assert all(row.solved and row.digits > 4 for row in rows if row.solver != "osqp")
    assert sum(row.solved for row in rows if row.solver == "osqp") > 60
    found = {
        mode: sum(r.iterations for r in rows if (r.solver, r.mode) == ("daqp", mode) and r.place)
        for mode in modes["daqp"]
    }
    assert found["active set"] < found["updates"] == found["cold"]


def test_a_callable_starts_from_its_own_answer_to_the_step_before(grasp, own):
    list(sequence_rows(grasp, {f"{own}:warm": ("primal-dual",)}, 1e-9, ONCE))
    starts = [json.loads(line) for line in Path("starts.jsonl").read_text().splitlines()]
    assert len(starts) == 24
    for place, (start, _) in enumerate(starts):
        if place % 12 == 0:
            assert start is None
        else:
            np.testing.assert_array_equal(start, starts[place - 1][1])


def test_a_callable_that_raises_costs_itself_only(grasp, own):
    modes = {f"{own}:broken": ("cold",), f"{own}:solved": ("cold",)}
    rows = list(sequence_rows(grasp, modes, 1e-9, ONCE))
    assert {row.solver: row.solved for row in rows} == {f"{own}:broken": False,
                                                        f"{own}:solved": True}  # fmt: skip


@pytest.mark.parametrize(("solver", "outcome", "words"), [
    ("hangs", "timeout", "killed after 0.5 s"),
    ("eats", "memory", "GB of memory"),
    ("dies", "crashed", "ended with status 3"),
])  # fmt: skip
def test_a_solver_that_hangs_eats_or_dies_costs_itself_only(grasp, own, solver, outcome, words):
    """After each start of its process it is right twice: of 6 steps 4, 2 ended."""
    bad, one = f"{own}:{solver}", {"stack/0": grasp["stack/0"][:6]}
    wait = 30.0 if solver == "eats" else 0.5
    limits = SolverLimits(repetitions=1, call=wait, warm_up=wait, memory=5e8)
    modes = {bad: ("cold",), "daqp": ("cold",)}
    rows = list(sequence_rows(one, modes, 1e-9, limits))
    assert all(row.solved and row.digits > 12 for row in rows if row.solver == "daqp")
    ends = [row for row in rows if row.solver == bad]
    assert len(ends) == 6
    assert [row.outcome for row in ends] == ["solved", "solved", outcome] * 2
    for row in ends:
        assert row.digits > 12 if row.solved else (words in row.said and row.digits == 0)


def test_a_budget_ends_a_solver_and_no_other(grasp, own):
    """A hang takes its limit and what is waited beyond it, 1 s: two of them are over 1.5 s."""
    assert 0.5 + EXTRA == 1.0
    bad, one = f"{own}:hangs", {"stack/0": grasp["stack/0"]}
    limits = SolverLimits(repetitions=1, call=0.5, warm_up=0.5, budget=1.5)
    modes = {bad: ("cold",), "daqp": ("cold",)}
    rows = list(sequence_rows(one, modes, 1e-9, limits))
    assert sum(row.outcome == "timeout" for row in rows) == 2
    late = [row for row in rows if row.outcome == "not_run_budget"]
    assert {row.solver for row in late} == {bad}
    assert len(late) == 12 - 2 * 3


def test_a_clock_that_was_stopped_is_not_believed(grasp, own):
    one = {"stack/0": grasp["stack/0"]}
    rows = list(sequence_rows(one, {f"{own}:stops_the_clock": ("cold",)}, 1e-9, ONCE))
    assert all(row.solved and row.seconds > 4e-3 for row in rows)


def test_a_callable_that_cannot_be_imported_is_refused(own, tmp_path, capsys):
    (tmp_path / "no_solvers.py").write_text("raise RuntimeError('no licence')")
    assert main(["study", "sequences", "no_solvers:solve"]) == 2
    assert "cannot be imported: RuntimeError: no licence" in capsys.readouterr().err


def test_the_command_tells_what_ended_and_goes_on(own, capsys):
    command = ["study", "sequences", f"{own}:dies", "daqp", "--modes", "cold", "--scenario",
               "door", "--stride", "4", "--repetitions", "1"]  # fmt: skip
    assert main(command) == 0
    assert f"{own}:dies, cold: 4 crashed" in capsys.readouterr().out


def test_the_command_writes_a_row_for_each_problem_and_mode(own, tmp_path, capsys):
    command = ["study", "sequences", "daqp", f"{own}:warm", "--scenario", "door", "--stride", "4",
               "--repetitions", "1", "--out", str(tmp_path)]  # fmt: skip
    assert main(command) == 0
    assert "active set" in capsys.readouterr().out
    with (tmp_path / "sequences.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 12 * (3 + 2)
    assert {row["said"] for row in rows} == {"optimal", "returned"}
