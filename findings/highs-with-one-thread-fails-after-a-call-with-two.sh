#!/usr/bin/env bash
# HiGHS 1.16.0 (highspy) through CVXPY 1.9.3 and through qpsolvers 4.12.0: a linear program of one row is solved, and
# solved again with threads=1, as whoever times solvers asks for.
# Expected: the same answer. What comes on a machine of two cores or more: CVXPY's SolverError ("Solver 'HIGHS' failed"),
# qpsolvers' None ("not found"), since the first call made a pool of threads for the whole process, and another number
# of them is an error; HiGHS's own sentence of it is among what both switch off. In a new process threads=1 is right,
# and after highspy.Highs.resetGlobalScheduler it is right in this one, too.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet cvxpy==1.9.3 highspy==1.16.0 qpsolvers==4.12.0 numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" - << 'PYTHON'
import warnings

import cvxpy as cp
import highspy
import numpy as np
import qpsolvers
from scipy.sparse import csc_matrix

warnings.simplefilter("ignore")


def by_qpsolvers(**options):
    one = csc_matrix(np.eye(1))
    return qpsolvers.solve_qp(one, np.zeros(1), -one, -np.ones(1), solver="highs", **options)


x = cp.Variable()
problem = cp.Problem(cp.Minimize(x), [x >= 1])
print("threads=1 in a new process:", problem.solve(solver="HIGHS", threads=1))
highspy.Highs.resetGlobalScheduler(True)
print("as many as there are:      ", problem.solve(solver="HIGHS"))
try:
    problem.solve(solver="HIGHS", threads=1)
    error = None
except cp.SolverError as raised:
    error = str(raised)
print("threads=1 after that:       SolverError:", error)
print("qpsolvers, threads=1:      ", by_qpsolvers(threads=1))
assert error is not None and "failed" in error
assert by_qpsolvers(threads=1) is None
highspy.Highs.resetGlobalScheduler(True)
print("after a reset:             ", problem.solve(solver="HIGHS", threads=1), by_qpsolvers(threads=1))
PYTHON
