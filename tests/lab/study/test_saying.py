"""What solvers say: read from a table of exit codes, which the solvers' own codes bear out."""

import numpy as np
import pytest

from quasistatic_ref.lab.study.saying import INFEASIBLE, OTHER, SOLVED, saying
from tests.lab.study.asked import BY_NAME, SETTINGS, Program, Solver, call_of, installed_here, table

HIGH = next(one for one in SETTINGS if one.name == "high")
WAYS = [(door, name) for door in BY_NAME for name in installed_here(door)]
ONE_WORD = [("qpsolvers", name) for name in ("daqp", "highs", "quadprog")]
"""Behind this door they have one word for all that is not solved."""


@pytest.mark.parametrize("way", [w for w in WAYS if w[1] not in ("cvxopt", "ecos", "qoco")])
def test_each_solver_says_of_a_program_whether_it_has_a_solution(way):
    """Of x >= 1 alone, and of x >= 1 with x <= 0."""
    solver = Solver(way[1], *way)
    call = call_of(solver)
    options = solver.asked(HIGH, 5.0)[0] if solver.takes(HIGH) else {}

    def said(A, b):
        program = Program(np.eye(1), np.zeros(1), np.array(A), np.array(b))
        return saying(*way, call(program, options).status)

    assert said([[1.0]], [1.0]) == SOLVED
    assert said([[1.0], [-1.0]], [1.0, 0.0]) == (OTHER if way in ONE_WORD else INFEASIBLE)


def test_every_solver_names_the_page_of_its_options():
    assert all(facts["source"].startswith("https://") for facts in table().values())
