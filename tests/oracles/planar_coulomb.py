"""All solutions of a planar step under Coulomb's law, by brute force in fractions.

Every contact is open, slides one way or the other, or sticks; every combination is tried. The
unknowns are the impulses p_n and p_t of the closed contacts. Equations are eliminated by hand, and
inequalities by Fourier and Motzkin's method. Nothing of the package is used: a step is read field
by field.
"""

from fractions import Fraction
from itertools import product

import numpy as np

from tests.oracles.rational_kkt import exact, solution

OPEN, LEFT, RIGHT, STICK = "open", "left", "right", "stick"


def planar_solutions(step):
    """Isolated solutions x as tuples of fractions, and sets as bounds of each coordinate.

    Parameters
    ----------
    step : StepData
        Un-actuated, without torsion; nothing moves along d2. The pyramid's p_2 then changes
        nothing, and leaves |p_1| <= mu p_n.

    Returns
    -------
    set of tuple, list of list of (low, high)
        The points that lie in no set; bounds are None where there are none.
    """
    c = step.contacts
    assert step.n_a == 0
    assert set(c.rows.tolist()) <= {4}
    assert not np.einsum("ji,jiv->jv", c.d2, c.J[:, :3]).any()
    M_u = exact(step.M_u)
    H_inverse = np.array([solution(M_u, e) for e in exact(np.eye(step.n_v))])  # of h H
    h = Fraction(step.h)
    normal, along = (
        [exact(axis) @ exact(J[:3]) for axis, J in zip(axes, c.J, strict=True)]
        for axes in (c.n, c.d1)
    )
    free = h * h * H_inverse @ exact(step.tau_u)
    # What an impulse of 1 N s does to x = (h H)^-1 (h^2 tau + h J'p).
    by_normal, by_along = ([h * H_inverse @ J for J in rows] for rows in (normal, along))
    points, sets = set(), []
    for modes in product((OPEN, LEFT, RIGHT, STICK), repeat=c.n_c):
        columns, signs, equations, inequalities = [], [], [], []
        for j, mode in enumerate(modes):
            mu = Fraction(c.mu_v[j])
            if mode in (LEFT, RIGHT):  # one unknown, p_n: friction is all there is, against it
                way = -mu if mode == RIGHT else mu
                columns.append(by_normal[j] + way * by_along[j])
                signs.append({len(columns) - 1: 1})
            elif mode == STICK:  # two unknowns
                columns += [by_normal[j], by_along[j]]
                k = len(columns)
                signs += [{k - 2: mu, k - 1: 1}, {k - 2: mu, k - 1: -1}, {k - 2: 1}]
        count = len(columns)

        def of(row, constant=Fraction(0), columns=columns):
            """Row x + constant as an affine function of the unknowns: coefficients, constant."""
            return [row @ column for column in columns] + [row @ free + constant]

        for j, mode in enumerate(modes):
            gap = of(normal[j], Fraction(c.phi[j]))
            slip = of(along[j])
            if mode == OPEN:
                inequalities.append(gap)
                continue
            equations.append(gap)
            if mode == STICK:
                equations.append(slip)
            else:
                inequalities.append(slip if mode == RIGHT else [-a for a in slip])
        for sign in signs:
            inequalities.append([Fraction(sign.get(k, 0)) for k in range(count)] + [Fraction(0)])
        x = [[column[v] for column in columns] + [free[v]] for v in range(step.n_v)]
        bounds = ranges(equations, inequalities, x, count)
        if bounds is None:
            continue
        if all(low is not None and low == high for low, high in bounds):
            points.add(tuple(low for low, _ in bounds))
        else:
            sets.append((bounds, (equations, inequalities, x, count)))
    outside = {p for p in points if not any(holds(p, *system) for _, system in sets)}
    return outside, [bounds for bounds, _ in sets]


def holds(point, equations, inequalities, functions, count):
    """Whether some solution of a system has given values of the affine functions."""
    known = [[*row[:-1], row[-1] - a] for row, a in zip(functions, point, strict=True)]
    return ranges(equations + known, inequalities, [], count) is not None


def ranges(equations, inequalities, functions, count):
    """Least and largest value of each affine function where all hold; None if nothing does."""
    solved = {}
    for equation in equations:
        row = substituted(equation, solved, count)
        pivot = next((k for k in range(count) if row[k]), None)
        if pivot is None:
            if row[-1]:
                return None
            continue
        row = [-a / row[pivot] for a in row]
        row[pivot] = Fraction(0)
        solved = {k: substituted(own, {pivot: row}, count) for k, own in solved.items()}
        solved[pivot] = row
    left = [k for k in range(count) if k not in solved]

    def reduced(row):
        row = substituted(row, solved, count)
        return [row[k] for k in left] + [row[-1]]

    held = [reduced(row) for row in inequalities]
    if not feasible(held):
        return None
    bounds = []
    for function in functions:
        row = reduced(function)
        if not any(row[:-1]):
            bounds.append((row[-1], row[-1]))
            continue
        # One more unknown, t = row: it stands last, and all others are eliminated.
        more = [[*one[:-1], Fraction(0), one[-1]] for one in held]
        for sign in (1, -1):
            more.append([*(sign * a for a in row[:-1]), Fraction(-sign), sign * row[-1]])
        rest = eliminated_rows(more, len(left))
        lows = [-b / a for a, b in rest if a > 0]
        highs = [-b / a for a, b in rest if a < 0]
        bounds.append((max(lows, default=None), min(highs, default=None)))
    return bounds


def substituted(row, solved, count):
    """An affine function with some unknowns expressed by the others."""
    row = list(row)
    for k, own in solved.items():
        factor = row[k]
        if factor:
            row[k] = Fraction(0)
            row = [a + factor * b for a, b in zip(row, own, strict=True)]
    assert len(row) == count + 1
    return row


def feasible(rows):
    """Whether affine functions can all be >= 0."""
    width = len(rows[0]) - 1 if rows else 0
    return all(row[0] >= 0 for row in eliminated_rows(rows, width))


def eliminated_rows(rows, count):
    """What inequalities a u + b >= 0 say without their first `count` unknowns.

    After k unknowns, what is combined of more than k + 1 of them follows from the others (Kohler
    1967). Equal rows that are combined of different ones count each: the rule may leave out what
    follows from the one, and needs the other.
    """
    combined = {}
    for i, row in enumerate(rows):
        keep_smallest(combined, tuple(scaled(row)), frozenset([i]))
    for k in range(1, count + 1):
        each = [(row, of) for row, ways in combined.items() for of in ways]
        plus = [one for one in each if one[0][0] > 0]
        minus = [one for one in each if one[0][0] < 0]
        combined = {row[1:]: ways for row, ways in combined.items() if row[0] == 0}
        for (p, of_p), (m, of_m) in product(plus, minus):
            if len(of_p | of_m) <= k + 1:
                row = scaled([a / p[0] - b / m[0] for a, b in zip(p[1:], m[1:], strict=True)])
                keep_smallest(combined, tuple(row), of_p | of_m)
    return list(combined)


def keep_smallest(combined, row, of):
    """Add a way to combine a row, unless it is there from fewer of the same ones."""
    ways = combined.setdefault(row, [])
    if not any(way <= of for way in ways):
        ways[:] = [way for way in ways if not of <= way] + [of]


def scaled(row):
    """An inequality divided by the size of its first coefficient."""
    size = next((abs(a) for a in row if a), Fraction(1))
    return [a / size for a in row]
