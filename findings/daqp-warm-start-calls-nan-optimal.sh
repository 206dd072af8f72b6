#!/usr/bin/env bash
# DAQP 0.11.0: a body lies in a corner of three walls; in the next program, in the same workspace and with the same unit Hessian,
# the walls have turned until their normals are nearly dependent (by 2^-16). Each program has the answer x = 0, proved here by multipliers in fractions.
# Expected: x = 0 twice, or an exit flag that says what failed. What comes: exit flag 1, "optimal", with x = NaN.
# A workspace of its own, or the same one told to forget its active set (sense = 0), finds x = 0.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet daqp==0.11.0 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
from fractions import Fraction

import daqp
import numpy as np

# Minimise 1/2 x'x + f'x subject to A x >= 0: the answer is x = 0 if f is A' of multipliers that are not negative.
PROGRAMS = {
    "first": ([0, 1, 1], [[1, 0, 0], [0, 1, 0], [0, 0, 1]], [0, 1, 1]),
    "second": ([-1, 1, 0], [[-(2**-16), -1, -1], [0, 1, 0], [0, 1, 1]], [2**16, 1, 2**16]),
}
for f, A, multipliers in PROGRAMS.values():
    assert min(multipliers) >= 0
    assert all(sum(Fraction(row[i]) * m for row, m in zip(A, multipliers)) == f[i] for i in range(3))


def arrays(name):
    f, A, _ = PROGRAMS[name]
    return np.array(f, float), np.array(A, float)


def set_up(name):
    model = daqp.Model()
    f, A = arrays(name)
    flag, _ = model.setup(np.eye(3), f, A, np.full(3, np.inf), np.zeros(3), np.zeros(3, np.int32))
    assert flag > 0
    return model


def solve(model, title):
    x, _, flag, _ = model.solve()
    print(f"{title}: exit flag {flag}, x = {x}")
    assert flag == 1
    return x


def second(title, **also):
    """The answer to the second program after that to the first."""
    model = set_up("first")
    assert np.allclose(solve(model, "first"), 0, atol=1e-9)
    f, A = arrays("second")
    model.update(f=f, A=A, **also)
    return solve(model, title)


assert np.allclose(solve(set_up("second"), "second, by itself"), 0, atol=1e-9)
assert np.allclose(second("second, cold", sense=np.zeros(3, np.int32)), 0, atol=1e-9)
assert np.isnan(second("second, warm")).all()
PYTHON
