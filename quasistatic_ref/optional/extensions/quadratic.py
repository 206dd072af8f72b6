r"""A quadratic program in delta_q alone, from costs and constraints with further variables.

CVXPY states costs and constraints as

.. math:: \min \tfrac12 z^T P z + c^T z \quad\text{s.t.}\quad A_0 z = b_0,\; A_1 z \le b_1,
          \qquad z = (y, \delta q)

with auxiliaries y: a user's own, and those that CVXPY introduces. Its float64 numbers are taken as
they stand. Where the equations bind y, elimination in rational numbers gives y as an affine
function of delta_q. What is left is a cost and rows of delta_q, whose numbers are rounded once.
"""

from collections.abc import Mapping, Sequence

import cvxpy as cp
import cvxpy.settings as words
import numpy as np
from flint import fmpq_mat

from quasistatic_ref.exact.program import exact_matrix
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import nearest_fraction
from quasistatic_ref.optional.extensions.conic import conic_program
from quasistatic_ref.optional.gap import rational
from quasistatic_ref.solve.step_problem import CANON
from quasistatic_ref.step.data import Extra


def quadratic_program(
    costs: Sequence[cp.Expression],
    constraints: Sequence[cp.Constraint],
    unknowns: Sequence[cp.Variable],
) -> Extra | None:
    """Costs and constraints as a quadratic cost and rows of the unknowns.

    Parameters
    ----------
    costs : sequence of cvxpy.Expression
        Scalars.
    constraints : sequence of cvxpy.Constraint
    unknowns : sequence of cvxpy.Variable
        Of which the program is: delta_q_a and delta_q_u.

    Returns
    -------
    Extra or None
        None if CVXPY states them with cones, if the equations do not bind every auxiliary, or if
        they are not convex by its rules.
    """
    problem = cp.Problem(cp.Minimize(sum(costs, start=cp.Constant(0.0))), list(constraints))
    try:
        data, _, _ = problem.get_problem_data(
            cp.CLARABEL, ignore_dpp=True, canon_backend=CANON, solver_opts={}
        )
    except (cp.error.DCPError, cp.error.SolverError):
        return None  # whoever solves them in another way says why
    program = conic_program(data)
    if program.zero + program.nonnegative != len(program.b):
        return None
    n_z = len(program.c)
    coordinates = _columns(unknowns, data[words.PARAM_PROB].var_id_to_col, absent=n_z)
    auxiliaries = np.setdiff1d(np.arange(n_z), coordinates).tolist()
    k = len(auxiliaries)
    n = len(coordinates)
    order = [*auxiliaries, *coordinates]
    P = np.pad(program.P, (0, 1))[np.ix_(order, order)]
    c = np.pad(program.c, (0, 1))[order]
    A = np.pad(program.A, ((0, 0), (0, 1)))[:, order]
    # With w = (y, delta_q, 1) the cost is w'Qw / 2; equations are R w = 0, inequalities R w >= 0.
    Q = np.block([[P, c[:, None]], [c[None], np.zeros((1, 1))]])
    R = np.column_stack([-A, program.b])
    solved, rank = rational(exact_matrix(R[: program.zero])).rref()
    equations = solved.tolist()[:rank]
    if [row[:k] for row in equations[:k]] != _identity(k):
        return None
    bound = [-v for row in equations[:k] for v in row[k:]]  # y, as rows of (delta_q, 1)
    same = [v for row in _identity(n + 1) for v in row]
    W = fmpq_mat(k + n + 1, n + 1, [*bound, *same])
    cost = _rounded(W.transpose() * rational(exact_matrix(Q)) * W)
    inequalities = _rounded(rational(exact_matrix(R[program.zero :])) * W)
    left = _rounded(fmpq_mat(rank - k, n + 1, [v for row in equations[k:] for v in row[k:]]))
    rows = np.vstack([inequalities, left, -left])
    names = [f"extension bound[{i}]" for i in range(len(inequalities))]
    for end in ("", " reversed"):
        names += [f"extension equation[{i}]{end}" for i in range(len(left))]
    return Extra(tuple(names), rows[:, :n], -rows[:, n], H=cost[:n, :n], g=-cost[:n, n])


def _columns(unknowns: Sequence[cp.Variable], first: Mapping[int, int], absent: int) -> list[int]:
    """Column numbers of the unknowns' entries; `absent` for those without a first column."""
    columns: list[int] = []
    for x in unknowns:
        entries = range(first[x.id], first[x.id] + x.size) if x.id in first else [absent] * x.size
        columns += entries
    return columns


def _identity(k: int) -> list[list[int]]:
    return [[int(i == j) for j in range(k)] for i in range(k)]


def _rounded(M: fmpq_mat) -> Array:
    """Fractions, each rounded to the nearest float64 [any unit]."""
    numbers = [nearest_fraction(v) for v in M.entries()]
    return np.array(numbers, dtype=np.float64).reshape(M.nrows(), M.ncols())
