"""Failures of other projects that this one works around: a test fails when one of them is mended.

Then docs/studies.md, which lists them, is out of date, and the workaround may go.
"""

from quasistatic_ref.lab.folders import contact_qp_folder
from quasistatic_ref.lab.study.problems.folder import set_read
from quasistatic_ref.optional.qpsolvers.through_qpsolvers import qpsolvers_reply


def test_proxqp_still_calls_problems_infeasible_that_have_an_exact_answer():
    names = ("mass_ratio/7.99853/30", "mass_ratio/775.59/96", "limits/0.000769265/8",
             "gaps/0.00152334/19", "bodies/5/33")  # fmt: skip
    problems = [one for one in set_read(contact_qp_folder()) if one.id in names]
    assert all(problem.feasible for problem in problems)
    claims = [qpsolvers_reply(one.natural.form, "proxqp", {}).status for one in problems]
    assert "PROXQP_PRIMAL_INFEASIBLE" in claims
