"""STUDY.toml: what it means, and that a mistake in it is one sentence."""

import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.study.calling.options import has_accuracy, options_at
from quasistatic_ref.lab.study.calling.study_only import EVERY
from quasistatic_ref.lab.study.measuring.plan import plan

HEAD = 'format = "quasistatic-ref/study"\nversion = 1\n'
RUN = '[[runs]]\nsolvers = ["qpsolvers:daqp"]\n'
MINE = '[solvers.mine]\ncallable = "planted_solvers:honest"\n'

BAD = {
    "an unknown field": ("tim_limit = 1", "tim_limit: is unknown; did you mean 'time_limit'?"),
    "no problems": ("problems.families.scenarios = 0", "problems.families: must name at least one"),
    "an unknown scenario": ('problems.scenarios = ["bunny"]', "did you mean 'bunny_grasp'?"),
    "an unknown solver": ('[[runs]]\nsolvers = ["qpsolvers:dapq"]', "did you mean 'daqp'?"),
    "an unknown interface": ('[[runs]]\nsolvers = ["a:daqp"]', "runs[0].solvers: holds no solver"),
    "an unknown setting": (RUN + 'settings = ["hihg"]', "did you mean 'high'?"),
    "options of no setting": (MINE + "options.higher.a = 1", "solvers.mine.options.higher"),
    "a promise of no setting": (MINE + "promised.higher = 3.0", "solvers.mine.promised.higher"),
    "a promise of no residual": (MINE + "promised.high.primla = 1.0", "primla is no residual"),
    "a promise of no term": (
        MINE + 'promised.high.gap = { rel = 1.0, of = ["|z|"] }',
        "solvers.mine.promised.high: must be digits, or a table of primal, dual and gap",
    ),
    "a setting without accuracy": ("[settings.mine]\n", "settings.mine.accuracy: is missing"),
    "a setting that says nothing to a solver": (
        MINE + '[[runs]]\nsolvers = ["mine"]\nsettings = ["high"]',
        "hold nothing that callable:mine can be set to",
    ),
}
"""What a schema cannot know; what it can is in test_spec_schema.py."""


@pytest.mark.parametrize("name", BAD)
def test_a_mistake_is_one_sentence_that_names_file_field_and_remedy(name, study):
    text, says = BAD[name]
    with pytest.raises(InputError) as refused:
        study(text)
    assert says in str(refused.value)
    assert "study.toml" in str(refused.value)
    assert "\n" not in str(refused.value)


def test_bad_files_end_the_command_with_status_2(tmp_path, cli):
    for name, content, says in (
        ("a.toml", "x = ", "is not TOML"),
        ("b.toml", "format = 3", "format"),
        ("c.toml", None, "no such file"),
        ("d.toml", HEAD.replace("version", "vesrion"), "vesrion: is unknown; did you mean"),
    ):
        path = tmp_path / name
        if content is not None:
            path.write_text(content)
        said = cli("study", "run", path, "--out", tmp_path / "out", status=2).err
        assert says in said
        assert said.removeprefix("loads solvers\n").count("\n") == 1
    assert "did you mean 'default'?" in cli("study", "run", "defalt", status=2).err


@pytest.mark.parametrize("name", [name for name in EVERY if has_accuracy(name)])
def test_a_tighter_accuracy_never_asks_for_less(name):
    loose, tight = (options_at(name, "cvxpy", accuracy) for accuracy in (1e-3, 1e-9))
    assert loose.keys() == tight.keys()
    changed = [key for key in loose if loose[key] != tight[key]]
    assert changed
    assert all(tight[key] < loose[key] for key in changed)


def test_all_solvers_are_run_on_a_problem_before_the_next_and_take_turns(study):
    spec = study(
        "[problems]\nfamilies.scenarios = 6\n[[runs]]\n"
        'solvers = ["qpsolvers:daqp", "qpsolvers:osqp", "qpsolvers:clarabel"]\nagain = 1'
    )
    problems = [(f"p{i}", "f") for i in range(6)]
    planned = plan(spec, problems)
    assert len(planned) == 6 * 3 * 2
    blocks = [planned[i : i + 3] for i in range(0, len(planned), 3)]
    assert all(len({(m.problem, m.repetition) for m in block}) == 1 for block in blocks)
    assert {block[0].solver.name for block in blocks} == {"daqp", "osqp", "clarabel"}
    assert [b[0].repetition for b in blocks] == [0] * 6 + [1] * 6  # the noise, after all others
    assert [block[0].problem for block in blocks[:6]] != [p for p, _ in problems]  # scattered


def test_settings_come_in_an_order_that_is_drawn_for_each_problem(study):
    text = 'settings = ["default", "low", "mid", "high", "tuned"]\nagain = 0\n'
    spec = study(f"[problems]\nfamilies.scenarios = 8\n{RUN}{text}")
    problems = [(f"p{i}", "f") for i in range(8)]
    planned = plan(spec, problems)
    orders = {tuple(m.setting.name for m in planned[i : i + 5]) for i in range(0, 40, 5)}
    assert all(len(set(order)) == 5 for order in orders)
    assert len(orders) > 4
    assert planned == plan(spec, problems)


def test_a_measurement_that_two_tables_contain_is_made_once(study):
    once = RUN + "again = 0\n"
    four = "[problems]\nfamilies.scenarios = 4\n"
    spec = study(four + once + once + "every = 2\nunits = ['raw']")
    planned = plan(spec, [(f"p{i}", "f") for i in range(4)])
    assert sorted(m.units for m in planned) == ["natural"] * 4 + ["raw"] * 2
    again = study(four + once + once)
    assert len(plan(again, [(f"p{i}", "f") for i in range(4)])) == 4


def test_only_solvers_that_take_a_start_are_called_warm(study):
    spec = study(
        "[problems]\nfamilies.scenarios = 1\n[[runs]]\nagain = 0\nwarm = [false, true]\n"
        'solvers = ["qpsolvers:daqp", "qpsolvers:piqp"]'
    )
    planned = plan(spec, [("p", "f")])
    assert sorted((m.solver.name, m.warm) for m in planned) == [
        ("daqp", False), ("daqp", True), ("piqp", False)]  # fmt: skip


def test_a_studys_own_options_replace_ours(study):
    text = '[solvers.mine]\nqpsolvers = "osqp"\noptions.high = { eps_abs = 1e-7 }\n'
    (solver,) = study(text + '[[runs]]\nsolvers = ["mine"]\nsettings = ["high"]').solvers
    (setting,) = study(text + '[[runs]]\nsolvers = ["mine"]\nsettings = ["high"]').settings
    assert solver.settings_of(setting, 1.0) == {"eps_abs": 1e-7}
