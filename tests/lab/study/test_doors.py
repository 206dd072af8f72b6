"""What a function returns, and what its row says of it."""

import importlib

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.study.compiled_problems import CompiledProblems
from quasistatic_ref.lab.study.limits import Limits
from quasistatic_ref.lab.study.run import study
from quasistatic_ref.solve.backends import BACKENDS
from quasistatic_ref.step.standard_form import StandardForm
from tests.lab.study import broken

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


def test_what_a_function_returns_is_judged_as_it_is(tmp_path, three):
    functions = [getattr(broken, name) for name in RETURNED]
    limits = Limits(repetitions=1)
    rows = study(three[:1], functions, folder=tmp_path, limits=limits)
    said = {row.solver: (row.outcome, row.claim, row.false_claim, row.status) for row in rows}
    assert said == RETURNED
    assert all((row.digits is not None) == (row.outcome == "solved") for row in rows)


def test_a_function_whose_module_is_not_there_is_one_sentence(tmp_path, monkeypatch, three):
    module = tmp_path / "fleeting_solver.py"
    module.write_text("def solve(P, q, G, h):\n    return None, None, 'infeasible'\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    function = importlib.import_module("fleeting_solver").solve
    module.unlink()
    with pytest.raises(InputError, match="solve: cannot be imported: ModuleNotFoundError: No mod"):
        study(three, [function], folder=tmp_path / "store")


def test_a_cold_start_through_cvxpy_knows_nothing_of_the_reply_before():
    form = StandardForm(np.array([[3.0, 1.0], [1.0, 2.0]]), np.array([0.0, 4.0]), np.eye(2),
                        np.array([1.0, -9.0]))  # fmt: skip
    programs = CompiledProblems("osqp")
    options = BACKENDS["osqp"].attempts(1e-10)[0][1]
    first, warm, cold = (programs.reply(form, options, warm=w) for w in (False, True, False))
    assert cold.iterations == first.iterations > warm.iterations
