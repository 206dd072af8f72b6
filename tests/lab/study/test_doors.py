"""What a function returns, and what its row says of it."""

import json

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.study.compiled_problems import CompiledProblems
from quasistatic_ref.solve.backends import BACKENDS
from quasistatic_ref.step.standard_form import StandardForm

STUDY = """
repetitions = 1
[problems]
set = "contact-qp"
families.contacts = {{ count = 1, most = 12 }}
{solvers}
[[runs]]
solvers = {names}
"""


def study_of(*functions):
    """A study of functions, each by its own name."""
    names = [function.partition(":")[2] for function in functions]
    tables = [
        f'[solvers.{name}]\nfunction = "{function}"'
        for name, function in zip(names, functions, strict=True)
    ]
    return STUDY.format(solvers="\n".join(tables), names=json.dumps(names))


RETURNED = {
    "honest": ("solved", "optimal", False, "optimal"),
    "spoils": ("solved", "optimal", False, "optimal"),
    "zeros": ("solved", "optimal", True, "optimal"),
    "too_long": ("wrong shape", "neither", False, "optimal"),
    "no_numbers": ("wrong shape", "neither", False, "optimal"),
    "pair": ("wrong shape", "neither", False, "returned a tuple in place of (x, z, status)"),
    "nan": ("not a number", "optimal", True, "optimal"),
    "gives_up": ("failed", "neither", False, "too many sweeps"),
    "denies": ("failed", "infeasible", True, "infeasible"),
    "raises": ("failed", "neither", False, "RuntimeError: no licence at all"),
}


def test_what_a_function_returns_is_judged_as_it_is(run):
    rows = run(study_of(*(f"solvers.py:{name}" for name in RETURNED)))
    said = {row.solver: (row.outcome, row.claim, row.false_claim, row.status) for row in rows}
    assert said == RETURNED
    assert all((row.digits is not None) == (row.outcome == "solved") for row in rows)


@pytest.mark.parametrize(("function", "words"), [
    ("solver.py:honest", "No such file"), ("solvers.py:honst", "has no attribute 'honst'"),
    ("no_such_module:f", "No module named"), ("solvers.py:np", "is not a function"),
])  # fmt: skip
def test_a_function_that_is_not_there_is_one_sentence_before_the_study_runs(
    function, words, run, tmp_path
):
    with pytest.raises(InputError, match=words):
        run(study_of(function))
    assert not (tmp_path / "store").exists()


def test_a_cold_start_through_cvxpy_knows_nothing_of_the_reply_before():
    form = StandardForm(np.array([[3.0, 1.0], [1.0, 2.0]]), np.array([0.0, 4.0]), np.eye(2),
                        np.array([1.0, -9.0]))  # fmt: skip
    programs = CompiledProblems("osqp")
    options = BACKENDS["osqp"].first(1e-10)
    first, warm, cold = (programs.reply(form, options, warm=w) for w in (False, True, False))
    assert cold.iterations == first.iterations > warm.iterations
