"""Failures of other projects that this one works around: a test fails when one of them is mended.

Then docs/studies.md, which lists them, is out of date, and the workaround may go.
"""

import numpy as np
import pytest

from quasistatic_ref import StepProblem
from quasistatic_ref.lab.bench.scenes import boxes
from quasistatic_ref.lab.folders import CONTACT_QP, problem_set_folder
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.optional.qpsolvers.through_qpsolvers import qpsolvers_reply
from quasistatic_ref.solve.problem_data import CANON


def test_proxqp_still_calls_problems_infeasible_that_have_an_exact_answer():
    names = ("mass_ratio/7.99853/30", "mass_ratio/775.59/96", "limits/0.000769265/8",
             "gaps/0.00152334/19", "bodies/5/33")  # fmt: skip
    problems = set_read(problem_set_folder(CONTACT_QP), ids=names)
    assert all(problem.feasible for problem in problems)
    claims = [qpsolvers_reply(one.natural.form, "proxqp", {}).status for one in problems]
    assert "PROXQP_PRIMAL_INFEASIBLE" in claims


def test_cvxpy_still_fails_to_compile_a_large_step_in_its_own_way():
    scene = boxes(3)
    step = scene.simulator("off", True).step(scene.q, np.zeros(0), scene.force).step
    fails = StepProblem(step)
    works = StepProblem(step)
    assert sum(parameter.size for parameter in fails.parameters.values()) >= 1000
    with pytest.raises(ValueError, match="truth value of an array"):
        fails.problem.solve(solver="CLARABEL")
    works.problem.solve(solver="CLARABEL", canon_backend=CANON)
    assert works.problem.status == "optimal"
