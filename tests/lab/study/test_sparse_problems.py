"""Sparse problems: in which matrices each door hands them on, and what comes back."""

import pytest
import qpsolvers
from scipy.sparse import issparse

from quasistatic_ref.lab.study.doors import call_of
from quasistatic_ref.lab.study.grade import grades, problem_forms
from quasistatic_ref.lab.study.solvers import BY_NAME, SETTINGS, Solver, installed_here

HIGH = next(one for one in SETTINGS if one.name == "high")
LESS = {("cvxpy", "cvxopt"), ("cvxpy", "ecos"), ("qpsolvers", "ecos")}
"""Cone programs stand in the place of the quadratic one: 3 digits are asked of them."""


@pytest.mark.parametrize("way", [(door, name) for door in BY_NAME for name in installed_here(door)])
def test_every_solver_answers_a_wall_of_bricks(way, members):
    """60 coordinates and 128 rows, the answer known to 6.8 digits."""
    wall = next(one for one in members if one.id == "sparse/10/0")
    solver = Solver(way[1], *way)
    setting = HIGH if solver.takes(HIGH) else SETTINGS[0]
    forms = problem_forms(wall)
    form = forms.forms["natural"]
    assert issparse(form.H)
    options = solver.settings_of(setting, 10.0)
    reply = call_of(solver, ".")[0](form, options, None)
    assert reply.call_seconds > 0
    row = grades(forms, "natural", reply, solver, solver.promise(setting, options), 1e-9)
    assert row["claim"] == "optimal"
    assert min(row["digits"], row["digits_net"]) > (3 if way in LESS else 6)


def test_which_solvers_are_given_sparse_matrices_is_what_qpsolvers_says():
    here = installed_here("qpsolvers")
    sparse = {name for name in here if Solver(name, "qpsolvers", name).sparse}
    assert sparse == set(qpsolvers.sparse_solvers) & set(here)
