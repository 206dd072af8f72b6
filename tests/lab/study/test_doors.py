"""What a function returns, and what its row says of it."""

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
[solvers.mine]
function = "{function}"
[[runs]]
solvers = ["mine"]
"""
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


@pytest.mark.parametrize("name", RETURNED)
def test_what_a_function_returns_is_judged_as_it_is(name, run):
    (row,) = run(STUDY.format(function=f"solvers.py:{name}"))
    assert (row.outcome, row.claim, row.false_claim, row.status) == RETURNED[name]
    assert (row.digits is not None) == (row.outcome == "solved")


@pytest.mark.parametrize(("function", "words"), [
    ("solver.py:honest", "No such file"), ("solvers.py:honst", "has no attribute 'honst'"),
    ("no_such_module:f", "No module named"), ("solvers.py:np", "is not a function"),
])  # fmt: skip
def test_a_function_that_is_not_there_is_one_sentence_before_the_study_runs(
    function, words, run, tmp_path
):
    with pytest.raises(InputError, match=words):
        run(STUDY.format(function=function))
    assert not (tmp_path / "store").exists()


def test_a_cold_start_through_cvxpy_knows_nothing_of_the_reply_before():
    form = StandardForm(np.array([[3.0, 1.0], [1.0, 2.0]]), np.array([0.0, 4.0]), np.eye(2),
                        np.array([1.0, -9.0]))  # fmt: skip
    programs = CompiledProblems("osqp")
    options = BACKENDS["osqp"].first(1e-10)
    first, warm, cold = (programs.reply(form, options, warm=w) for w in (False, True, False))
    assert cold.iterations == first.iterations > warm.iterations
