"""Why the answer of a quadratic program is wrong, in fractions, by Lemke's method."""

from fractions import Fraction

import numpy as np

from tests.oracles.lemke import nearest, only_multipliers, optima
from tests.oracles.rational_kkt import exact, solution


def in_rows(program):
    """P, q, a, h in fractions of a program as a_i x <= h_i, names of rows, how many are equations.

    These are the first: those of A, and bounds that are equal. P is its symmetric part.
    """
    lb, ub = program["lb"], program["ub"]
    eye, fixed = np.eye(len(lb)), lb == ub
    limits = [
        ("A", program["A"], program["b"], True),
        ("lb", -eye, -lb, fixed),
        ("G", program["G"], program["h"], True),
        ("lb", -eye, -lb, ~fixed),
        ("ub", eye, ub, ~fixed),
    ]
    there = [np.isfinite(h) & which for _, _, h, which in limits]
    rows = [*zip(limits, there, strict=True)]
    names = [f"{name}[{i}]" for (name, *_), some in rows for i in np.flatnonzero(some)]
    a = np.concatenate([a[some] for (_, a, *_), some in rows])
    h = np.concatenate([h[some] for (_, _, h, _), some in rows])
    P, q, a, h = map(exact, (program["P"], program["q"], a, h))
    return ((P + P.T) / 2, q, a, h), names, int(there[0].sum() + fixed.sum())


def floats(values):
    """Each number rounded correctly, as Python does it."""
    return [float(v) for v in values]


def refutation(answer, program):
    """What is wrong with an answer, None standing for a proof that there is no optimum; or None.

    x is the optimum of least norm. Multipliers are those of the active rows, which balance there.
    """
    (P, q, a, h), names, e = in_rows(program)
    every = optima(P, q, a, h, e)
    if every is None or answer is None:
        return None if every is answer is None else "the kind"
    x = nearest(every, 0 * q)
    slope, tight = P @ x + q, np.flatnonzero(h == a @ x)
    W = [names.index(name) for name in answer.active]
    y = exact(np.zeros(len(h)))
    y[W] = solution(a[W] @ a[W].T, -a[W] @ slope)
    if any(slope + a.T @ y) or any(v < 0 for v in y[e:]) or not {*W} <= {*tight}:
        return "active"
    fields = {"z": 0 * exact(answer.z), "y": 0 * exact(answer.y), "z_box": 0 * q}
    for name, v in zip(names, y, strict=True):
        field, i = name[:-1].split("[")
        name_of = {"G": "z", "A": "y"}.get(field, "z_box")
        fields[name_of][int(i)] += -v if field == "lb" else v
    for name, values in {"x": x, **fields}.items():
        if floats(values) != getattr(answer, name).tolist():
            return name
    cost = x @ P @ x / 2 + q @ x + Fraction(program.get("constant", 0))
    if answer.obj != float(cost) or abs(Fraction(answer.obj) - cost) > answer.obj_error:
        return "obj"
    if answer.multipliers_unique != only_multipliers(a[tight], {*range(sum(tight < e))}, y[tight]):
        return "multipliers_unique"
    # The optima are a convex set: if x is nearest to x + s and to x - s, s is at right angles to
    # the way to each other one, which one at random is not.
    s = exact(np.random.default_rng(0).integers(-(10**6), 10**6, len(q)))
    if answer.x_unique != all(list(nearest(every, c)) == list(x) for c in (x + s, x - s)):
        return "x_unique"
    return None
