#!/usr/bin/env bash
# Clarabel 0.11.1, with its own options: the cheapest point (x, y) in a region of five straight edges, at a cost of 0.0005 (x^2 + y^2) - 0.02 x - 0.01 y:
# a strictly convex program with room inside, whose answer (29/3, 15) lies on two edges, and is proved here in fractions.
# Expected: an answer. What comes: MaxIterations after 200 steps, and after 2000, at a point that is wrong by 1.2, and by 1.4 without equilibration.
# Where a step may go 0.95 of its way to the border, in place of 0.99, ten steps solve it.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet clarabel==0.11.1 numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" - << 'PYTHON'
from fractions import Fraction

import clarabel
import numpy as np
from scipy.sparse import csc_matrix

EDGES = [[0, 3], [-3, 1], [-3, 2], [1, 3], [0, 3]]  # each times (x, y) is at least
ENDS = [-1, -14, 1, -1, -12]
ANSWER = [Fraction(29, 3), Fraction(15)]
PRICES = [0, Fraction(17, 9000), Fraction(7, 4500), 0, 0]  # of the edges: two are reached

slope = [Fraction(1, 1000) * v - c for v, c in zip(ANSWER, [Fraction(1, 50), Fraction(1, 100)])]
assert slope == [sum(price * row[i] for price, row in zip(PRICES, EDGES)) for i in range(2)]
room = [sum(a * v for a, v in zip(row, ANSWER)) - end for row, end in zip(EDGES, ENDS)]
assert room[1] == room[2] == 0 and min(room[:1] + room[3:]) > 40


def solve(**options):
    """The status, the number of steps and the point."""
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    for name, value in options.items():
        setattr(settings, name, value)
    P = csc_matrix(0.001 * np.eye(2))
    q = np.array([-0.02, -0.01])
    rows = csc_matrix(-np.array(EDGES, float))
    cones = [clarabel.NonnegativeConeT(5)]
    found = clarabel.DefaultSolver(P, q, rows, -np.array(ENDS, float), cones, settings).solve()
    return str(found.status), found.iterations, np.array(found.x)


exact = np.array(ANSWER, float)
for options in {}, {"max_iter": 2000}, {"equilibrate_enable": False}:
    status, steps, point = solve(**options)
    print(f"{options}: {status} after {steps} steps at {point.round(3)}, off by {np.abs(point - exact).max():.2g}")
    assert status == "MaxIterations"
    assert np.abs(point - exact).max() > 0.1
status, steps, point = solve(max_step_fraction=0.95)
print(f"steps of at most 0.95 of the way: {status} after {steps} steps at {point.round(3)}")
assert status == "Solved" and np.allclose(point, exact, atol=1e-5)
PYTHON
