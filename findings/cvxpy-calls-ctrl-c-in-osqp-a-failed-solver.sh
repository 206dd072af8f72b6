#!/usr/bin/env bash
# CVXPY 1.9.3 with OSQP 1.1.3: SIGINT (Ctrl-C) arrives while OSQP solves a long quadratic program.
# Expected: KeyboardInterrupt, as in every line of Python. What comes: OSQP takes the signal for itself and answers "interrupted";
# CVXPY raises SolverError with the words of any failure, so that a loop that goes on after failed solves cannot be ended.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet cvxpy==1.9.3 osqp==1.1.3 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import os
import signal
import threading

import cvxpy as cp
import numpy as np

signal.signal(signal.SIGINT, signal.default_int_handler)
random = np.random.default_rng(0)
x = cp.Variable(40)
g = random.normal(size=40)
A = random.normal(size=(150, 40))
problem = cp.Problem(cp.Minimize(cp.sum_squares(x) / 2 - g @ x), [A @ x >= -1])
problem.solve(solver=cp.OSQP)  # compiled here
print("without a signal:", problem.status)

# A tolerance that no solver reaches: the solve lasts until its limit of time.
threading.Timer(2.0, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    problem.solve(solver=cp.OSQP, eps_abs=1e-18, eps_rel=1e-18, max_iter=10**9, time_limit=60.0)
    ended = problem.status
except BaseException as error:
    ended = f"{type(error).__name__}: {error}"
print("with SIGINT:", ended)
assert ended.startswith("SolverError: Solver 'OSQP' failed."), ended
PYTHON
