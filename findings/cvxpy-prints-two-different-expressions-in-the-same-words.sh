#!/usr/bin/env bash
# CVXPY 1.9.3: sums that are transposed, indexed or negated, as they are printed.
# Expected: brackets, so that the text says what the expression is. What comes: (X + Y)' and X + Y' are both "X + Y.T", though
# their values differ, and the first entry of x + y is "x + y[0]"; a negated sum has its brackets.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet cvxpy==1.9.3 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import cvxpy as cp
import numpy as np

X, Y = cp.Variable((2, 2), "X"), cp.Variable((2, 2), "Y")
x, y = cp.Variable(2, "x"), cp.Variable(2, "y")
X.value, Y.value = np.array([[1.0, 2.0], [3.0, 4.0]]), np.array([[10.0, 20.0], [30.0, 40.0]])
x.value, y.value = np.array([1.0, 2.0]), np.array([10.0, 20.0])
one, other = (X + Y).T, X + Y.T
print(f"the transpose of a sum is printed as {one}: {one.value.tolist()}")
print(f"a sum with a transpose is printed as {other}: {other.value.tolist()}")
assert str(one) == str(other) == "X + Y.T"
assert not np.array_equal(one.value, other.value)
first = (x + y)[0:1]
print(f"the first entry of a sum is printed as {first}: {first.value}; x + y[0] is {x.value + y.value[0]}")
assert str(first) == "x + y[0]"
assert np.array_equal(first.value, [11.0])
print(f"-(x + y) is printed as {-(x + y)}")
assert str(-(x + y)) == "-(x + y)"
PYTHON
