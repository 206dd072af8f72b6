"""Exact answers for any convex quadratic program, in the words of qpsolvers.

Minimise 1/2 x'Px + q'x subject to G x <= h, A x = b, lb <= x <= ub. The units are the user's:
each number is in those of its row or column, and of the objective.

| letter | what it is |
|---|---|
| `P` | the quadratic cost, (n, n) |
| `q` | the linear cost, (n,) |
| `G` | inequalities, (k, n), with sides `h` |
| `lb`, `ub` | bounds, (n,) |
| `z` | multipliers of inequalities, (k,) |
| `z_box` | multipliers of bounds, (n,) |
| `obj`, `obj_error` | the objective, and a bound of its error |
"""
