"""Claims of solvers: read from a table of exit codes, which the solvers' own codes bear out."""

import numpy as np
import pytest

from quasistatic_ref.lab.study.claims import HIDDEN, INFEASIBLE, OPTIMAL, claim, exit_codes
from quasistatic_ref.lab.study.doors import call_of
from quasistatic_ref.lab.study.promises import RESIDUALS
from quasistatic_ref.lab.study.solvers import BY_NAME, SETTINGS, Solver, installed_here, table
from quasistatic_ref.step.standard_form import StandardForm

HIGH = next(one for one in SETTINGS if one.name == "high")
WAYS = [(door, name) for door in BY_NAME for name in installed_here(door)]


@pytest.mark.parametrize("way", [w for w in WAYS if w[1] not in ("cvxopt", "ecos", "qoco")])
def test_each_solver_says_of_a_program_whether_it_has_a_solution(way):
    """Of x >= 1 alone, and of x >= 1 with x <= 0."""
    solver = Solver(way[1], *way)
    call = call_of(solver)
    options = solver.settings_of(HIGH, 5.0) if solver.takes(HIGH) else {}

    def claim_on(A, b):
        form = StandardForm(np.eye(1), np.zeros(1), np.array(A), np.array(b))
        return claim(*way, call(form, options, None).status)

    assert claim_on([[1.0]], [1.0]) == OPTIMAL
    wanted = HIDDEN if HIDDEN in exit_codes(*way) else INFEASIBLE
    assert claim_on([[1.0], [-1.0]], [1.0, 0.0]) == wanted


@pytest.mark.parametrize("way", WAYS)
def test_every_solver_that_takes_an_accuracy_promises_residuals_of_it(way):
    """1e-9 is asked for: no residual that the documentation states has a larger absolute part."""
    door, name = way
    facts = table()[name]
    assert facts["source"].startswith("https://")
    if "accuracy" not in facts:
        return
    assert facts["promise"]["source"].startswith("https://")
    solver = Solver(name, door, name)
    promise = solver.promise(HIGH, solver.settings_of(HIGH, 1.0))
    stated = facts.get(door, {}).get("promise", facts["promise"])
    assert {"primal"} <= stated.keys() <= {"source", *RESIDUALS}
    for residual in stated.keys() & set(RESIDUALS):
        if promise[residual] is not None and name != "highs":
            assert {promise[residual]["abs"], promise[residual]["rel"]} <= {0.0, 1e-9}
