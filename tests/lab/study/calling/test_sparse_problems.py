"""Sparse problems: in which matrices each interface is given them, and what comes back."""

from time import perf_counter

import pytest
from scipy.sparse import issparse

from quasistatic_ref.lab.folders import CONTACT_QP, problem_set_folder
from quasistatic_ref.lab.study.calling.calls import call_of
from quasistatic_ref.lab.study.calling.options import takes_sparse
from quasistatic_ref.lab.study.calling.solvers import SETTINGS, Solver
from quasistatic_ref.lab.study.calling.study_only import EVERY, installed_here, known_to
from quasistatic_ref.lab.study.measuring.grade import grades, problem_forms
from quasistatic_ref.lab.study.problems.folder import set_read

HIGH = next(one for one in SETTINGS if one.name == "high")
WAYS = [
    (interface, name)
    for interface in ("qpsolvers", "cvxpy", "native")
    for name in installed_here(interface)
    if name not in ("qpax", "mpax")  # compiled for a shape, at first sight of it
]
LESS = {("cvxpy", "cvxopt"), ("cvxpy", "ecos"), ("qpsolvers", "ecos")}
"""Cone programs stand in the place of the quadratic one: 3 digits are asked of them."""


@pytest.fixture(scope="module")
def wall():
    """Ten bricks; 60 coordinates, 128 rows, the answer known to 6.8 digits."""
    (found,) = set_read(problem_set_folder(CONTACT_QP), ids=["sparse/10/0"])
    return found


@pytest.mark.parametrize(("interface", "name"), WAYS)
def test_every_solver_answers_a_wall_of_bricks(interface, name, wall):
    solver = Solver(name, interface, name)
    setting = HIGH if solver.takes(HIGH) else SETTINGS[0]
    forms = problem_forms(wall)
    form = forms.forms["natural"]
    assert issparse(form.H)
    assert issparse(form.A)
    begin = perf_counter()
    reply = call_of(solver)(form, solver.settings_of(setting, 10.0), None)
    assert 0 < reply.call_seconds < perf_counter() - begin
    row = grades(forms, "natural", reply, solver, setting)
    assert row["said_optimal"]
    least = 3 if (interface, name) in LESS else 6
    assert min(row["digits"]["delta_q"], row["digits"]["net_wrench"]) > least


def test_which_solvers_are_given_sparse_matrices_is_what_qpsolvers_says():
    import qpsolvers

    ours = {name for name in known_to("qpsolvers") if takes_sparse(name, "qpsolvers")}
    here = set(qpsolvers.available_solvers) & set(EVERY)
    assert ours & here == set(qpsolvers.sparse_solvers) & here
    assert takes_sparse("my_solver:solve", "callable")
    assert not takes_sparse("./program", "executable")


def test_a_sparse_problem_is_asked_in_a_process_of_its_own(cli):
    assert (
        "60 coordinates, 128 rows"
        in cli("study", "ask", "sparse/10/0", "qpsolvers:piqp", "high").out
    )
