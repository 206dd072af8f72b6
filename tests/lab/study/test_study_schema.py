"""The JSON Schema and the reference page of study files say what the loader does."""

import json
import tomllib

import pytest
from jsonschema import Draft4Validator

from docs.fields_page import reference_page
from quasistatic_ref import InputError
from quasistatic_ref.formats.files import toml_read
from quasistatic_ref.lab.study.fields import TABLES, study_schema
from quasistatic_ref.lab.study.study_file import solver_study, study_names


def test_every_field_of_a_study_is_on_the_page_that_is_made_of_the_table():
    lines = reference_page(TABLES).splitlines()
    for fields in TABLES.values():
        for name, one in fields.items():
            assert any(
                s.startswith(f"| `{name}` |") and s.endswith(f"| {one.says} |") for s in lines
            )


HEAD = 'format = "quasistatic-ref/study"\nversion = 2\n'
MISTAKES = {
    "another format": (
        'format = "quasistatic-ref/scenario"\nversion = 2',
        "format: must be 'quasis",
    ),
    "no format": ("version = 2", ""),
    "a later version": ('format = "quasistatic-ref/study"\nversion = 1', ""),
    "no budget": (HEAD + "budget = 0.0", "budget: must be greater than 0"),
    "a budget beyond numbers": (HEAD + "budget = 1e16", ""),
    "more time than there is": (HEAD + "time_limit = 1e7", "time_limit: must be at most 1e+06"),
    "a word for a time": (HEAD + 'time_limit = "long"', ""),
    "half a problem": (HEAD + "problems.families.contacts = 0.5", ""),
    "an unknown family": (HEAD + "problems.families.contact = 1", "did you mean 'contacts'?"),
    "a number for a scenario": (
        HEAD + "problems.scenarios = [1]",
        "scenarios: must be a list of strings",
    ),
    "an unknown word of a setting": (HEAD + "settings.mine = { accuracy = 1e-3, tune = true }", ""),
    "no accuracy": (HEAD + "settings.mine.accuracy = 0.0", ""),
    "a solver of two kinds": (
        HEAD + 'solvers.me = { function = "a:b", qpsolvers = "daqp" }',
        "solvers.me: must say one of",
    ),
    "a solver of no kind": (HEAD + "solvers.me.options.high = {}", "solvers.me: must say one of"),
    "no function": (HEAD + 'solvers.me.function = "module"', "must read FILE.py:FUNCTION or"),
    "an option without a table": (HEAD + 'solvers.me = { function = "a:b", options.high = 1 }', ""),
    "a list for a solver": (
        HEAD + '[[runs]]\nsolvers = [["x"]]',
        "runs[0].solvers: must be a list of str",
    ),
    "no runs": (HEAD + "runs = []", "runs: must not be empty"),
    "no solvers": (HEAD + "[[runs]]\nsolvers = []", "runs[0].solvers: must not be empty"),
    "unknown units": (HEAD + '[[runs]]\nunits = ["si"]', "runs[0].units: holds an unknown one;"),
    "a lukewarm start": (HEAD + '[[runs]]\nstarts = ["tepid"]', "runs[0].starts: holds an unknown"),
    "cold and nothing": (HEAD + "[[runs]]\nstarts = []", ""),
    "no repetition": (HEAD + "repetitions = 0", "repetitions: must be at least 1"),
    "every half": (HEAD + "[[runs]]\nevery = 0.5", ""),
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


def test_the_command_prints_the_schema_of_studies(cli):
    assert json.loads(cli("schema", "study").out) == json.loads(json.dumps(study_schema()))
