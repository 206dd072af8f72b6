"""The JSON Schema and the reference page of study files say what the loader does."""

import tomllib

import pytest
from jsonschema import Draft4Validator

from quasistatic_ref import InputError
from quasistatic_ref.formats.files import toml_read
from quasistatic_ref.lab.study.fields import study_schema
from quasistatic_ref.lab.study.study_file import solver_study, study_names

HEAD = 'format = "quasistatic-ref/study"\nversion = 2\n'
MISTAKES = {
    "another format": (
        'format = "quasistatic-ref/scenario"\nversion = 2',
        "format: must be 'quasis",
    ),
    "a later version": ('format = "quasistatic-ref/study"\nversion = 1', ""),
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


@pytest.fixture(scope="module")
def validator():
    Draft4Validator.check_schema(study_schema())
    return Draft4Validator(study_schema())


@pytest.mark.parametrize(("text", "says"), MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_one_sentence_of_the_loader_and_refused_by_the_schema(
    text, says, validator, tmp_path
):
    path = tmp_path / "study.toml"
    path.write_text(text)
    with pytest.raises(InputError) as refused:
        solver_study(path, toml_read(path))
    assert says in str(refused.value)
    assert "\n" not in str(refused.value)
    assert not validator.is_valid(tomllib.loads(text))


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


@pytest.mark.parametrize("text", [HEAD, FULL])
def test_what_the_loader_takes_the_schema_takes(text, validator, tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(text)
    solver_study(path, toml_read(path))
    assert [error.message for error in validator.iter_errors(tomllib.loads(text))] == []


@pytest.mark.parametrize("name", sorted(study_names()))
def test_every_study_that_comes_along_is_valid(name, validator):
    assert validator.is_valid(tomllib.loads(study_names()[name].read_text()))
