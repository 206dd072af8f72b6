"""STUDY.toml: what it means, and that the loader and the JSON Schema refuse the same mistakes."""

import tomllib

import pytest
from jsonschema import Draft4Validator

from quasistatic_ref import InputError
from quasistatic_ref.formats.files import toml_read
from quasistatic_ref.lab.study.fields import study_schema
from quasistatic_ref.lab.study.problems.for_study import study_problems
from quasistatic_ref.lab.study.run import plan
from quasistatic_ref.lab.study.study_file import solver_study, study_names

HEAD = 'format = "quasistatic-ref/study"\nversion = 2\n'
MINE = f'{HEAD}[solvers.mine]\nfunction = "solvers.py:honest"\n'
MISTAKES = {
    "another format": (
        'format = "quasistatic-ref/scenario"\nversion = 2',
        "format: must be 'quasis",
    ),
    "a later version": ('format = "quasistatic-ref/study"\nversion = 1', "version: "),
    "an unknown field": (HEAD + "tim_limit = 1", "is unknown; did you mean 'time_limit'?"),
    "no budget": (HEAD + "budget = 0.0", "budget: must be greater than 0"),
    "an unknown family": (HEAD + "problems.families.contact = 1", "did you mean 'contacts'?"),
    "a solver of two kinds": (
        HEAD + 'solvers.me = { function = "a:b", qpsolvers = "daqp" }',
        "solvers.me: must say one of",
    ),
    "a solver of no kind": (HEAD + "solvers.me.options.high = {}", "solvers.me: must say one of"),
    "no function": (HEAD + 'solvers.me.function = "module"', "must read FILE.py:FUNCTION or"),
    "a list for a solver": (
        HEAD + '[[runs]]\nsolvers = [["x"]]',
        "runs[0].solvers: must be a list of str",
    ),
    "no runs": (HEAD + "runs = []", "runs: must not be empty"),
    "unknown units": (HEAD + '[[runs]]\nunits = ["si"]', "runs[0].units: holds an unknown one;"),
    "a lukewarm start": (HEAD + '[[runs]]\nstarts = ["tepid"]', "runs[0].starts: holds an unknown"),
    "no repetition": (HEAD + "repetitions = 0", "repetitions: must be at least 1"),
}
BEYOND_THE_SCHEMA = {
    "no problems": (
        HEAD + "problems.families.scenarios = 0",
        "problems.families: must name at least one",
    ),
    "an unknown solver": (HEAD + '[[runs]]\nsolvers = ["qpsolvers:dapq"]', "did you mean 'daqp'?"),
    "an unknown door": (HEAD + '[[runs]]\nsolvers = ["a:daqp"]', "runs[0].solvers: is no solver"),
    "options of no setting": (MINE + "options.higher.a = 1", "solvers.mine.options.higher"),
    "a promise of no residual": (MINE + "promised.high.primla = 1.0", "primla is no residual"),
    "a promise of no term": (
        MINE + 'promised.high.gap = { rel = 1.0, of = ["|z|"] }',
        "solvers.mine.promised.high: must be a table of primal, dual and gap",
    ),
    "a setting without accuracy": (HEAD + "[settings.mine]\n", "settings.mine.accuracy: is miss"),
    "a setting that says nothing to a solver": (
        MINE + '[[runs]]\nsolvers = ["mine"]\nsettings = ["high"]',
        "hold nothing that function:mine can be set to",
    ),
}
"""What a schema cannot know."""
FULL = f"""{HEAD}time_limit = 1
budget = 90.0
warm_up = 5
memory = 2.5
repetitions = 7
problems = {{ scenarios = ["stack"], families.scenarios = 3 }}
settings = {{ tight = {{ accuracy = 1e-11 }}, high = {{ tuned = true }} }}
[solvers.mine]
function = "my_module:solve"
options.tight = {{ a = [1, "b"] }}
[solvers.mine.promised]
default = {{ dual = 1e-3 }}
tight = {{ primal = 1e-9, gap = {{ abs = 1e-9, rel = 1e-9, of = ["|g'x|"] }} }}
[solvers.other]
qpsolvers = "osqp"
options.tight = {{ eps_abs = 1e-9 }}
[[runs]]
solvers = ["qpsolvers:*", "cvxpy:clarabel", "mine", "other"]
settings = ["default", "tight"]
units = ["raw", "natural"]
starts = ["cold", "warm"]
every = 1
"""


@pytest.fixture(scope="module")
def validator():
    Draft4Validator.check_schema(study_schema())
    return Draft4Validator(study_schema())


@pytest.mark.parametrize("name", [*MISTAKES, *BEYOND_THE_SCHEMA])
def test_a_mistake_is_one_sentence_of_the_loader_and_refused_by_the_schema(
    name, validator, tmp_path
):
    text, says = (MISTAKES | BEYOND_THE_SCHEMA)[name]
    path = tmp_path / "study.toml"
    path.write_text(text)
    with pytest.raises(InputError) as refused:
        solver_study(path, toml_read(path))
    assert str(refused.value).startswith(f"{path}: ")
    assert says in str(refused.value)
    assert "\n" not in str(refused.value)
    assert validator.is_valid(tomllib.loads(text)) == (name in BEYOND_THE_SCHEMA)


@pytest.mark.parametrize("text", [HEAD, FULL])
def test_what_the_loader_takes_the_schema_takes(text, validator, tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(text)
    solver_study(path, toml_read(path))
    assert [error.message for error in validator.iter_errors(tomllib.loads(text))] == []


@pytest.mark.parametrize("name", sorted(study_names()))
def test_every_study_that_comes_along_is_valid(name, validator):
    assert validator.is_valid(tomllib.loads(study_names()[name].read_text()))


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
    tuned = study(text + '[[runs]]\nsolvers = ["mine"]\nsettings = ["high"]')
    (solver,) = tuned.solvers
    (setting,) = tuned.settings
    assert solver.settings_of(setting, 1.0) == {"eps_abs": 1e-7}
