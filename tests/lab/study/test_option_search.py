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

from quasistatic_ref.lab.study.measuring.tuning import MOST_SETTINGS, Score
from quasistatic_ref.solve.backends import BACKENDS
from validation.make import option_search
from validation.make.option_report import report

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
def cells_of(text, first):
    """The cells of the lines of tables that begin so."""
    found = [line for line in text.splitlines() if line.startswith(f"| {first} |")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in found]


def test_the_sentences_on_options_are_made_of_the_committed_log(spaces, log, text):
    assert text == report(spaces, log)
    page = (VALIDATION.parent / "docs" / "solver_study.md").read_text("utf-8")
    assert "validation/results/option_search.md" in page


def test_the_tables_of_options_are_those_of_the_log(spaces, log, text):
    """A line for each setting judged, then one for each single change that the log has."""
    for solver, space in spaces.items():
        own = lines_of(log, solver)
        expected = [
            [f"{one['six']:.1f}", f"{one['nine']:.1f}", f"{one['median']:.1f}",
             str(one["false_optimal"]), str(one["false_infeasible"]),
             f"{1e3 * one['time_to_6']:.3g}"]
            for one in own["judging"]
        ]  # fmt: skip
        if own["all"]:
            for finding in space["findings"]:
                old, new = (
                    next(one for one in own["all"] if one["options"] == options)
                    for options in (finding["base"], finding["base"] | finding["change"])
                )
                pairs = [f"{old[n]:.1f} to {new[n]:.1f}" for n in ("six", "nine", "median")]
                false = f"{old['false_infeasible']} to {new['false_infeasible']}"
                ((name, value),) = finding["change"].items()
                word = f"{value:g}" if isinstance(value, float) else str(value)
                expected.append([f"`{name}={word}`", *pairs, false])
        assert [cells[2:] for cells in cells_of(text, solver)] == expected


def test_what_to_set_is_what_the_log_found_best(spaces, log, text):
    for solver, space in spaces.items():
        own = lines_of(log, solver)
        (found,) = re.findall(rf"^- \*\*{solver}\*\* at (.*)$", text, re.M) or [None]
        assert (found is None) == (solver in NOT_SEARCHED)
        if found is None:
            assert solver in text.splitlines()[-1]
            continue
        plain, start, best = own["judging"]
        numbers = re.match(r"`.*?` delivers 6 digits on (\S+) % and 9 digits on (\S+) % of (\d+) "
                           r"problems, at its defaults on (\S+) % and (\S+) %\.",
                           found)  # fmt: skip
        assert [*numbers.groups()] == [
            f"{best['six']:.1f}", f"{best['nine']:.1f}", str(best["problems"]),
            f"{plain['six']:.1f}", f"{plain['nine']:.1f}",
        ]  # fmt: skip
        assert ("This is the start" in found) == (best["options"] == start["options"])
        alone = [
            one for one in own["training"]
            if sum(space["start"].get(k) != v for k, v in one["options"].items()) <= 1
        ]  # fmt: skip
        for mean in re.findall(r"soonest: mean (\S+) ms", found):
            assert mean == f"{1e3 * min(one['time_to_6'] for one in alone[1:]):.3g}"
        for most in re.findall(r"most frequent with `.*?`: on (\S+) %", found):
            assert most == f"{max(one['nine'] for one in alone):.1f}"


# -- The command ----------------------------------------------------------------------------------
@pytest.fixture
def command(tmp_path, monkeypatch):
    """The command on two solvers and two problems; a = 2 halves the time, `broken` raises."""
    (tmp_path / "space.toml").write_text(
        "\n".join(f'{name} = {{ source = "https://example.org", start = {{ a = 1 }}, options = '
                  "{ a = [2], b = [1] }, findings = [{ base = { a = 1 }, change = { b = 1 } }] }"
                  for name in ("broken", "good"))
    )  # fmt: skip
    called = []

    def scored(solver, options, problems, function):
        called.append(solver)
        if solver == "broken":
            raise RuntimeError("this solver is broken")
        return replace(NOTHING, time_to_6=0.5 if options.get("a") == 2 else 1.0)

    monkeypatch.setattr(option_search, "SPACE", tmp_path / "space.toml")
    monkeypatch.setattr(option_search, "scored", scored)
    every = [SimpleNamespace(id=f"contacts/{k}/0") for k in range(8)]
    monkeypatch.setattr(option_search, "problems", lambda folder: every)
    out = tmp_path / "log.jsonl"
    return lambda *names: (option_search.main([*names, "--out", str(out)]), called), out


def test_a_solver_that_fails_stops_no_other_and_is_named(command, capsys):
    run, out = command
    with pytest.raises(SystemExit, match="not searched: broken"):
        run()
    log = [json.loads(line) for line in out.read_text().splitlines()]
    assert {one["solver"] for one in log} == {"good"}
    judged = [one["options"] for one in log if one["half"] == "judging"]
    assert judged == [{}, {"a": 1}, {"a": 2}]
    words = out.with_suffix(".md").read_text()
    assert "- **good** at `a=2`" in words
    assert words.endswith("not searched yet, of: broken.\n")
    assert "good, training: a=2: 0 % with 6 digits" in capsys.readouterr().out


def test_a_search_goes_on_with_the_solvers_that_the_log_does_not_have(command):
    run, out = command
    run("good")
    before = out.read_text()
    with pytest.raises(SystemExit, match="not searched: broken"):
        run("--missing")
    assert out.read_text() == before
    assert run("good", "--missing")[1].count("broken") == 1
