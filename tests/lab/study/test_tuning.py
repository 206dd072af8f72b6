"""The search of options: what it tries, what it finds, and that it is judged on other runs."""

import json
from dataclasses import replace
from types import SimpleNamespace

import pytest

from quasistatic_ref.lab.study.measuring import tuning
from quasistatic_ref.lab.study.measuring.tuning import (
    LIMITS,
    MOST_SETTINGS,
    Score,
    halves,
    run_of,
    scored,
    searched,
)

NOTHING = Score(1, 1.0, 0.0, 0.0, 0.0, 0, 0, 0)


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


def test_a_search_ends_after_so_many_settings_and_so_many_seconds():
    many = {f"o{k}": list(range(10)) for k in range(10)}
    assert len(searched({}, many, lambda _: NOTHING)) == MOST_SETTINGS
    assert len(searched({}, many, lambda _: NOTHING, seconds=0.0)) == 1


def test_osqp_polished_has_more_digits_than_not(problem):
    """One problem of what the committed search measured on 200."""
    plain = {"eps_abs": 1e-9, "eps_rel": 0.0, "max_iter": 20_000}
    digits = [scored("osqp", o, [problem]).median for o in (plain, plain | {"polishing": True})]
    assert digits[1] > digits[0] + 2


def test_what_patience_does_not_reach_counts_as_not_delivered(problem, monkeypatch):
    monkeypatch.setattr(tuning, "PATIENCE", 0.0)
    score = scored("daqp", {}, [problem, problem])
    assert (score.problems, score.six, score.solved) == (2, 0.0, 0)
    assert score.time_to_6 == pytest.approx(LIMITS.call)
