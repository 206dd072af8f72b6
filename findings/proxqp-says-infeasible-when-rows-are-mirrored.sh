#!/usr/bin/env bash
# ProxQP of proxsuite 0.8.0: three fingers carry at least 60 N together, and each a least force of its own, at the least cost: a strictly convex
# program with much room, whose answer (8, 49, 3) N is proved here by multipliers in fractions. Its rows are written twice: C x >= l and -C x <= -l.
# Expected: one answer. What comes: the first is solved, the second is "primal infeasible", dense and sparse, and
# whatever stands for the side that a row lacks: infinity, 1e20 or 1000 N.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet proxsuite==0.8.0 numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" - << 'PYTHON'
from fractions import Fraction

import numpy as np
import proxsuite
from scipy.sparse import csc_matrix

PER_NEWTON = ["0.0002", "0.0002", "0.0003"]  # cost: 1/2 x'Hx + g'x with this diagonal H
COST = ["2.3", "1.7", "2.2"]
ROWS = [[1, 1, 1], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
LEAST = [60, 8, 43, 3]  # N
ANSWER = [8, 49, 3]  # N; of the rows, that of the second finger alone is not active

slope = [Fraction(h) * x + Fraction(g) for h, x, g in zip(PER_NEWTON, ANSWER, COST)]
multipliers = [slope[1], slope[0] - slope[1], 0, slope[2] - slope[1]]
sums = [sum(c * x for c, x in zip(row, ANSWER)) for row in ROWS]
assert min(multipliers) >= 0
assert all(s >= low and (s == low or m == 0) for s, low, m in zip(sums, LEAST, multipliers))
assert all(sum(row[i] * m for row, m in zip(ROWS, multipliers)) == slope[i] for i in range(3))

H = np.diag(np.array(PER_NEWTON, float))
g = np.array(COST, float)
C = np.array(ROWS, float)
least = np.array(LEAST, float)


def solve(kind, lower, C, upper):
    """The status and the answer by ProxQP with its own options."""
    program = getattr(proxsuite.proxqp, kind).QP(3, 0, 4)
    matrix = csc_matrix if kind == "sparse" else np.asarray
    program.init(matrix(H), g, None, None, matrix(C), lower, upper)
    program.solve()
    return program.results.info.status.name, program.results.x


for kind in "dense", "sparse":
    for absent in np.inf, 1e20, 1000.0:
        status, x = solve(kind, least, C, np.full(4, absent))
        mirrored, y = solve(kind, np.full(4, -absent), -C, -least)
        print(f"{kind}, absent bound {absent:g}: {status} {x.round(3)}, mirrored: {mirrored} {y.round(3)}")
        assert status == "PROXQP_SOLVED"
        assert np.allclose(x, ANSWER, atol=1e-3)
        assert mirrored == "PROXQP_PRIMAL_INFEASIBLE"
PYTHON
