#!/usr/bin/env bash
# CVXPY 1.9.3 with ProxQP 0.8.0: a problem is solved, the bound in its constraint is changed, and it is solved again
# from its last answer (warm_start=True, as for a sequence of similar problems).
# Expected: the second answer. What comes: TypeError, since CVXPY passes arguments that ProxQP's update does not take.
# Without a warm start the second answer is right.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet cvxpy==1.9.3 proxsuite==0.8.0 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import cvxpy as cp
import numpy as np

x = cp.Variable(2)
b = cp.Parameter(2)
problem = cp.Problem(cp.Minimize(cp.sum_squares(x)), [x >= b])
b.value = np.array([1.0, 2.0])
problem.solve(solver="PROXQP", warm_start=True)
print("first answer:", x.value.round(6))
b.value = np.array([1.0, 3.0])
try:
    problem.solve(solver="PROXQP", warm_start=True)
    error = None
except TypeError as raised:
    error = str(raised).splitlines()[0]
print("second, warm: TypeError:", error)
problem.solve(solver="PROXQP", warm_start=False)
print("second, cold:", x.value.round(6))
assert error is not None and "incompatible function arguments" in error
assert np.allclose(x.value, b.value, atol=1e-6)
PYTHON
