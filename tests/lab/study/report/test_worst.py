"""What a solver's author looks at first, and the command that runs it on one problem again."""

import json
import math
import re
import shlex

import pytest

from quasistatic_ref import InputError
from quasistatic_ref.cli.main import main
from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.study.measuring.ask import question
from quasistatic_ref.lab.study.report.report import study_report
from quasistatic_ref.lab.study.store.store import contents
from tests.lab.study import made_store, plain_report
from tests.lab.study.plain_report import digits_delivered, rows_named, seconds

WEDGE = "capped_wedge/0.1/0"


def worst(tables):
    return [table for table in tables if table[0].startswith("Worst")]


def most(bound):
    """Digits to which an answer is known: -log10 of its bound, at most 16."""
    return min(16.0, -math.log10(bound)) if bound else 16.0


def test_the_ten_worst_miss_the_most_digits_and_then_take_longest(tables, rows):
    """Sorted again by plain loops, both downwards; 12 problems, of which 10 are shown."""
    bounds = {fact["id"]: fact["bound"] for fact in made_store.facts(12)}
    assert len(worst(tables)) == 3  # ant, bee and cat, each by one interface
    for _, where, _, body in worst(tables):
        own = rows_named(rows, where)
        assert len(own) == 12
        key = {}
        for row in own:
            missed = max(most(bounds[row["problem"]]) - digits_delivered(row), 0)
            key[row["problem"]] = (-missed, -seconds(row, made_store.LIMIT), row["problem"])
        assert [line[0] for line in body] == sorted(key, key=key.get)[:10]
        for problem, outcome, _, false, _, digits, known, time in body:
            assert plain_report.agrees(known, most(bounds[problem]))
            (row,) = (row for row in own if row["problem"] == problem)
            assert outcome == row["outcome"]
            assert plain_report.agrees(digits, digits_delivered(row))
            assert plain_report.agrees(time, 1e3 * seconds(row, made_store.LIMIT))
            assert false == ("yes" if row["wrong"] else "no")


def test_each_command_runs_the_same_again_and_finds_the_same(whole, monkeypatch, capsys):
    """Digits of a deterministic solver to the last; its options are those of the study."""
    monkeypatch.chdir(whole.parent)  # of the planted solvers
    rows = [row for row in contents(whole).rows if row["repetition"] == 0]
    page = markdown_page(study_report(whole, whole.parent))
    assert "Not called at high, which means nothing to them: callable:mine." in page
    tables = worst(plain_report.tables_of(page))
    with pytest.raises(InputError, match="is not a solver of the study"):
        question("mass_ratio/1/0", "qpsolvers:osqp", "default", store=whole)
    labels = {re.search(r"label = (\S+?)[,.]?$", where)[1] for _, where, *_ in tables}
    assert labels == {"qpsolvers:daqp", "callable:mine"}
    shown = [(where, line[0], line[4]) for _, where, _, body in tables for line in body]
    assert len(shown) == 2 * 5
    for where, problem, command in shown:
        words = shlex.split(command.strip("`"))
        assert words[:3] == ["quasistatic-ref", "study", "ask"]
        status = main([*words[1:], "--json"])
        found = json.loads(capsys.readouterr().out)
        (row,) = (r for r in rows_named(rows, where) if r["problem"] == problem)
        assert status == int(row["wrong"] or row["wrong_multipliers"])
        names = ("problem", "outcome", "claimed", "wrong", "setting")
        assert {n: found[n] for n in names} == {n: row[n] for n in names}
        assert found["digits"]["delta_q"] == pytest.approx(row["digits"]["delta_q"], abs=0.5)


def test_a_problem_of_the_set_is_run_without_any_store(cli):
    out = cli("study", "ask", WEDGE, "qpsolvers:daqp", "tuned").out
    assert "13 coordinates, 44 rows" in out
    assert "primal_tol=1e-12" in out
    assert re.search(r"digits +delta_q 1[3-6]\.\d", out)
    assert re.search(r"limits +primal [0-9.e-]+, dual [0-9.e-]+, gap", out)
    assert re.search(r"promised +primal 1e-12; dual 0.001", out)
    assert re.search(r"false claims +none", out)


def test_a_solver_of_a_study_has_the_name_that_its_file_gives_it(whole):
    one = question("mass_ratio/1/0", "mine", "default", store=whole)
    assert one.solver.label == "callable:mine"
    assert one.solver.promises(one.setting)["dual"]["abs"] == 1e-3


@pytest.mark.parametrize(("words", "problem"), [
    ((WEDGE, "qpsolvers:dapq", "default"), "did you mean 'daqp'"),
    ((WEDGE, "daqp", "default"), "neither interface:name nor module:function"),
    ((WEDGE, "qpsolvers:daqp", "tunde"), "did you mean 'tuned'"),
    ((WEDGE, "qpsolvers:clarabel", "default", "natural", True), "takes no start"),
    (("capped_wedge/0.1/x", "qpsolvers:daqp", "default"), "is not a problem of contact-qp"),
])  # fmt: skip
def test_what_cannot_be_run_is_refused_in_a_sentence(words, problem):
    with pytest.raises(InputError, match=problem):
        question(*words)
