"""``exact`` as a solver of qpsolvers, in code that calls qpsolvers alone."""

import numpy as np
import pytest
import qpsolvers
import scipy.sparse

import quasistatic_ref as qr
from tests.processes import printed_text

P = np.diag([2.0, 4.0])
Q = np.array([-2.0, -8.0])  # without rows the optimum is [1, 2]
HALF = {"ub": np.array([0.5, np.inf])}  # the box holds x_0: z_box = 2 - 2 * 0.5
TOTAL = {"A": np.ones((1, 2)), "b": np.array([0.0])}  # 2 x_0 - 2 = 4 x_1 - 8 = -y, x_0 = -x_1
BELOW = {"G": np.ones((1, 2)), "h": np.array([0.0])}


@pytest.fixture(autouse=True)
def registered():
    qr.register_qpsolvers()


@pytest.mark.parametrize("sparse", [False, True])
@pytest.mark.parametrize(
    ("rows", "x", "multipliers"),
    [
        ({}, [1, 2], {}),
        (HALF, [0.5, 2], {"z_box": [1, 0]}),
        (TOTAL, [-1, 1], {"y": [4]}),
        (BELOW, [-1, 1], {"z": [4]}),
    ],
    ids=["no row", "bounds", "equation", "inequality"],
)
def test_qpsolvers_gives_the_exact_answer_with_its_proof(sparse, rows, x, multipliers):
    as_given = scipy.sparse.csc_matrix if sparse else np.array
    matrices = {name: as_given(rows[name]) for name in "GA" if name in rows}
    problem = qpsolvers.Problem(as_given(P), Q, **rows | matrices)
    solution = qpsolvers.solve_problem(problem, solver="exact", initvals=np.zeros(2))
    assert solution.x.tolist() == x
    assert solution.obj == 0.5 * P.diagonal() @ np.square(x) + Q @ x
    assert {name: getattr(solution, name).tolist() for name in multipliers} == multipliers
    assert solution.is_optimal(1e-15)
    assert qr.verify(solution.extras["answer"])


def test_what_has_no_optimum_is_not_found_and_the_proof_is_handed_on():
    crossed = {"lb": np.ones(2), "ub": np.zeros(2)}
    flat = np.zeros((2, 2))
    assert qpsolvers.solve_qp(P, Q, **crossed, solver="exact") is None
    for program, proof in (((P, Q), qr.QPInfeasible), ((flat, Q), qr.QPUnbounded)):
        rows = crossed if proof is qr.QPInfeasible else {}
        problem = qpsolvers.Problem(*program, **rows)
        solution = qpsolvers.solve_problem(problem, solver="exact")
        assert (solution.found, solution.x) == (False, None)
        assert isinstance(solution.extras["proof"], proof)
        assert qr.verify(solution.extras["proof"])


@pytest.mark.parametrize(
    ("cost", "options", "kind", "says"),
    [
        (np.diag([1.0, -1.0]), {}, "ProblemError", "is not convex: x_1 costs less"),
        (np.diag([1.0, np.nan]), {}, "ProblemError", r"P\[1, 1\]: must be a finite number"),
        (P, {"eps_abs": 1e-9}, "ParamError", "eps_abs: is no option"),
    ],
)
def test_errors_are_those_of_qpsolvers(cost, options, kind, says):
    with pytest.raises(getattr(qpsolvers.exceptions, kind), match=says):
        qpsolvers.solve_qp(cost, Q, solver="exact", **options)


OF_OURS = "import quasistatic_ref as qr", "qr.register_qpsolvers()"
OF_A_STRANGER = (
    "from qpsolvers import available_solvers, solve_ls",
    "import numpy as np",
    *OF_OURS,
    "fit = solve_ls(np.eye(2), np.ones(2), ub=np.array([0.5, 2.0]), solver='exact')",
    "print(available_solvers.count('exact'), fit.tolist())",
)


def test_code_of_a_stranger_needs_two_lines():
    assert printed_text(*OF_A_STRANGER) == "1 [0.5, 1.0]"
