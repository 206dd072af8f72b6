"""STUDY.toml: what it means, and that a mistake in it is one sentence."""

import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.study.problems.for_study import study_problems
from quasistatic_ref.lab.study.run import plan

MINE = '[solvers.mine]\nfunction = "solvers.py:honest"\n'

BAD = {
    "an unknown field": ("tim_limit = 1", "tim_limit: is unknown; did you mean 'time_limit'?"),
    "no problems": ("problems.families.scenarios = 0", "problems.families: must name at least one"),
    "an unknown solver": ('[[runs]]\nsolvers = ["qpsolvers:dapq"]', "did you mean 'daqp'?"),
    "an unknown door": ('[[runs]]\nsolvers = ["a:daqp"]', "runs[0].solvers: is no solver"),
    "options of no setting": (MINE + "options.higher.a = 1", "solvers.mine.options.higher"),
    "a promise of no residual": (MINE + "promised.high.primla = 1.0", "primla is no residual"),
    "a promise of no term": (
        MINE + 'promised.high.gap = { rel = 1.0, of = ["|z|"] }',
        "solvers.mine.promised.high: must be a table of primal, dual and gap",
    ),
    "a setting without accuracy": ("[settings.mine]\n", "settings.mine.accuracy: is missing"),
    "a setting that says nothing to a solver": (
        MINE + '[[runs]]\nsolvers = ["mine"]\nsettings = ["high"]',
        "hold nothing that function:mine can be set to",
    ),
}
"""What a schema cannot know; what it can is in test_study_schema.py."""


@pytest.mark.parametrize("name", BAD)
def test_a_mistake_is_one_sentence_that_names_file_field_and_remedy(name, study):
    text, says = BAD[name]
    with pytest.raises(InputError) as refused:
        study(text)
    assert says in str(refused.value)
    assert "study.toml" in str(refused.value)
    assert "\n" not in str(refused.value)


def test_the_plan_has_each_measurement_once_a_solver_after_the_other(study):
    """Problems in one random order of all families, the same for each; `every` takes a part."""
    text = "[problems]\nset = 'contact-qp'\nfamilies = { gaps = 4, friction = 4 }\n"
    solvers = "[[runs]]\nsolvers = ['qpsolvers:daqp', 'qpsolvers:osqp']\n"
    whole = study(f"{text}{solvers}{solvers}every = 2\nunits = ['raw', 'natural']\n")
    problems = study_problems(whole.problems, "nowhere", progress=False)
    measurements = plan(whole, problems, ())
    assert [one.solver.name for one in measurements] == ["daqp"] * 12 + ["osqp"] * 12
    names = [[one.problem.id for one in measurements[k : k + 8]] for k in (0, 12)]
    assert names[0] == names[1] != [one.id for one in problems]
    assert [one.problem.id for one in measurements[:12] if one.units == "raw"] == names[0][::2]


def test_a_studys_own_options_replace_ours(study):
    text = '[solvers.mine]\nqpsolvers = "osqp"\noptions.high = { eps_abs = 1e-7 }\n'
    (solver,) = study(text + '[[runs]]\nsolvers = ["mine"]\nsettings = ["high"]').solvers
    (setting,) = study(text + '[[runs]]\nsolvers = ["mine"]\nsettings = ["high"]').settings
    assert solver.settings_of(setting, 1.0) == {"eps_abs": 1e-7}
