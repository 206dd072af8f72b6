"""The command that searches options: its spaces, its log, what is made of the log for the docs."""

import json
import re
import tomllib
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import piqp
import pytest
import qpalm

from quasistatic_ref.solve.backends import BACKENDS
from validation.make.option_report import report
from validation.make.option_search import (
    MOST_SETTINGS,
    Score,
    halves,
    run_of,
    scored,
    searched,
)

VALIDATION = Path(__file__).parents[3] / "validation"
NOT_SEARCHED: set[str] = set()
"""Solvers whose entry is new, and whose search was not run yet."""
FEWEST = 8
"""Values of options that are worth the name of a search."""
HALVES = ("training", "judging", "all")
NOTHING = Score(2, 1.0, 0.0, 0.0, 0.0, 0, 0, 0)


@pytest.fixture(scope="module")
def spaces():
    return tomllib.loads((VALIDATION / "make" / "option_search.toml").read_text("utf-8"))


@pytest.fixture(scope="module")
def log():
    text = (VALIDATION / "results" / "option_search.jsonl").read_text("utf-8")
    return [json.loads(line) for line in text.splitlines()]


@pytest.fixture(scope="module")
def text():
    return (VALIDATION / "results" / "option_search.md").read_text("utf-8")


def lines_of(log, solver):
    return {h: [o for o in log if (o["solver"], o["half"]) == (solver, h)] for h in HALVES}


def test_every_solver_with_options_has_a_space_with_a_source(spaces):
    """The method of quadprog has no tolerance, and its function no option."""
    assert set(spaces) == set(BACKENDS) - {"quadprog"}
    for space in spaces.values():
        assert space["source"].startswith("https://")
        values = sum(map(len, space["options"].values()))
        # The start, each value alone, and each together with the best so far.
        assert values >= FEWEST
        assert 1 + 2 * values <= MOST_SETTINGS
        for finding in space["findings"]:
            assert finding["base"] in ({}, space["start"])


def test_names_that_would_be_passed_over_in_silence_exist(spaces):
    """Options of these two that their settings do not have are dropped by qpsolvers."""
    for solver, settings in (("piqp", piqp.DenseSolver().settings), ("qpalm", qpalm.Settings())):
        space = spaces[solver]
        for name in {*space["start"], *space["options"]} - {"backend"}:
            assert hasattr(settings, name), (solver, name)


def test_the_committed_log_holds_what_the_file_of_options_asks_for(spaces, log):
    assert {one["solver"] for one in log} <= set(spaces)
    for solver, space in spaces.items():
        lines = lines_of(log, solver)
        own = {half: [one["options"] for one in lines[half]] for half in HALVES}
        assert (solver in NOT_SEARCHED) == (not own["judging"])
        if own["judging"]:
            assert own["training"][0] == space["start"]
            assert len(own["training"]) <= MOST_SETTINGS
            assert len(own["judging"]) == 3  # its defaults, the start, the best
            best = min(lines["training"], key=lambda one: one["time_to_6"])
            assert own["judging"] == [{}, space["start"], best["options"]]
            for finding in space["findings"]:
                assert finding["base"] | finding["change"] in own["all"]


# -- What is made of it ---------------------------------------------------------------------------
def test_the_sentences_on_options_are_made_of_the_committed_log(spaces, log, text):
    assert text == report(spaces, log)
    page = (VALIDATION.parent / "docs" / "solver_study.md").read_text("utf-8")
    assert "validation/results/option_search.md" in page


def test_what_to_set_is_what_the_log_found_best(spaces, log, text):
    """Shares of the best setting and of the defaults, of each solver that was searched."""
    for solver in spaces:
        own = lines_of(log, solver)
        (found,) = re.findall(rf"^- \*\*{solver}\*\* at (.*)$", text, re.M) or [None]
        assert (found is None) == (solver in NOT_SEARCHED)
        plain, start, best = own["judging"]
        numbers = re.match(r"`.*?` delivers 6 digits on (\S+) % and 9 digits on (\S+) % of (\d+) "
                           r"problems, at its defaults on (\S+) % and (\S+) %\.",
                           found)  # fmt: skip
        assert [*numbers.groups()] == [
            f"{best['six']:.1f}", f"{best['nine']:.1f}", str(best["problems"]),
            f"{plain['six']:.1f}", f"{plain['nine']:.1f}",
        ]  # fmt: skip
        assert ("This is the start" in found) == (best["options"] == start["options"])


# -- The search ----------------------------------------------------------------------------------


def named(*names):
    return [SimpleNamespace(id=name) for name in names]


def test_steps_of_one_run_are_never_in_both_halves():
    scenes, slabs = ("door", "stack", "bunny_grasp"), [f"contacts/{k}/{k}" for k in range(40)]
    steps = [f"{scene}/{k}" for scene in scenes for k in range(20)]
    again = ["time_step/bunny_grasp,h=0.1/7", "closest_points/bunny_grasp,contacts.grip.k=3/9"]
    training, judging = halves(named(*steps, *slabs, *again))
    runs = [{run_of(one.id) for one in half} for half in (training, judging)]
    assert not runs[0] & runs[1]
    assert len(training) + len(judging) == len(steps) + len(slabs) + len(again)
    assert {run_of(name) for name in again} == {run_of("bunny_grasp/1")}
    of_slabs = [sum(one.id in slabs for one in half) for half in (training, judging)]
    assert min(of_slabs) > 10  # each was made alone


def test_what_helps_alone_is_put_together_while_it_helps():
    """T = 8 / 2 for a = 1, / 2 for b = 1, * 3 for both c = 1 and b = 1, / 1.5 for c alone."""

    def score(options):
        a, b, c = (options.get(name) == 1 for name in "abc")
        time = 8.0 / (2 if a else 1) / (2.5 if b else 1) * (3 if b and c else 1 / 1.5 if c else 1)
        return replace(NOTHING, time_to_6=time)

    tried = searched({}, {"a": [0, 1], "b": [1, 2], "c": [1]}, score)
    best, found = min(tried, key=lambda one: one[1].time_to_6)
    assert best == {"a": 1, "b": 1} | {k: v for k, v in best.items() if v != 1}
    assert found.time_to_6 == pytest.approx(8 / 2 / 2.5)
    options = [json.dumps(o, sort_keys=True) for o, _ in tried]
    assert len(set(options)) == len(options)


def test_a_setting_is_scored_by_its_digits_on_the_problems(problem):
    score = scored("quadprog", {}, [problem])
    assert (score.problems, score.six, score.nine, score.solved) == (1, 100.0, 100.0, 1)
    assert score.median > 12
