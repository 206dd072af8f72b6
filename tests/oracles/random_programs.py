"""Quadratic programs at random that are hard to prove: ties, dependent rows, scales, an ulp."""

from fractions import Fraction

import numpy as np

from tests.oracles.rational_kkt import exact


def random_program(seed, singular=False):
    """The P, q, G, h, A, b, lb, ub of a program, by name; some have no solution.

    A singular P has any rank, and of many of these programs the cost falls without end.
    """
    rng = np.random.default_rng(seed)
    n, k, e = (int(rng.integers(*each)) for each in ((1, 6), (0, 9), (0, 3)))
    whole_numbers = rng.random() < 0.5 or singular

    def sometimes(share):
        return rng.random() < share

    def numbers(*shape):
        if whole_numbers:
            return rng.integers(-3, 4, shape).astype(float)
        return rng.normal(size=shape)

    B = numbers(n, n)
    P = B @ B.T + np.eye(n)
    if singular:
        B = B[:, : rng.integers(0, n + 1)]
        P = B @ B.T
    elif sometimes(0.3):  # nearly singular: pivots of 2^-40 or so
        B = rng.integers(-3, 4, (n, n))
        B[-1] = B[:-1].sum(axis=0)
        P = B @ B.T + 2.0 ** -rng.integers(30, 43) * np.eye(n)
    if sometimes(0.2):  # nothing couples the parts
        part = np.arange(n) < n // 2
        P *= part[:, None] == part
    x, G, A = numbers(n), numbers(k, n), numbers(e, n)
    h = G @ x + (rng.integers(0, 2, k) if whole_numbers else rng.exponential(size=k)) * (
        rng.integers(0, 2, k)
    )
    b = A @ x
    if k and sometimes(0.3):  # rows that are there twice, or follow from others
        one = np.eye(k)
        sums = np.vstack([one, one[0], one[0] + one[-1], 0 * one[0]])
        G, h = sums @ G, sums @ h
    if e and sometimes(0.5):
        sums = np.vstack([np.eye(e), 2 * np.eye(e)[0], np.ones(e)])
        A, b = sums @ A, sums @ b
    if sometimes(0.15):
        if e:  # one equation contradicts its double
            A, b = np.vstack([A, 4 * A[-1]]), np.append(b, 4 * np.nextafter(b[-1], np.inf))
        elif k:  # one inequality contradicts another
            G, h = np.vstack([G, -G[0]]), np.append(h, -np.nextafter(h[0], np.inf))
    lb, ub = np.full(n, -np.inf), np.full(n, np.inf)
    if sometimes(0.5):
        low, high = rng.random((2, n)) < 0.5
        lb[low] = np.floor(x[low])
        ub[high] = np.ceil(x[high]) + rng.integers(0, 2, high.sum())
    q = numbers(n) * rng.choice([0.0, 1.0, 1.0, 10.0])
    if sometimes(0.2):  # rows without slack at x bear nothing
        q = -(P @ x)
    if singular and sometimes(0.3):  # an end
        q = P @ q - G.T @ np.maximum(numbers(len(G)), 0)
    if sometimes(0.3):
        u, v, w, s = 2.0 ** rng.integers(-110, 111, 4)  # of x, of rows, of equations and of P
        P, q = P * s, q * s * u
        G, A = G * v, A * w
        h, b, lb, ub = h * v * u, b * w * u, lb * u, ub * u
    if sometimes(0.1):
        h[: len(h) // 2] = np.inf
    return {"P": P, "q": q, "G": G, "h": h, "A": A, "b": b, "lb": lb, "ub": ub}


MINOR = [[2.0**31, 1.0], [1.0, 2.0**30]]
"""Two rows whose minor is 2^61 - 1, the prime that the package asks first."""
TERMS = ("P", "q", "G", "h", "A", "b", "lb", "ub")


def program_on_equations(seed):
    """A program whose P is convex only where equations and fixed variables leave it.

    It is made around an optimum x, beside which there are often others. Of some the cost falls
    without end, some have no solution, and some are not convex.
    """
    rng = np.random.default_rng(seed)
    n, k, e = (int(rng.integers(*each)) for each in ((1, 7), (0, 8), (0, 4)))

    def sometimes(share):
        return rng.random() < share

    def numbers(*shape):
        return rng.integers(-3, 4, shape).astype(float)

    x, G, A = numbers(n), numbers(k, n), numbers(e, n)
    if min(e, n) > 1 and sometimes(0.2):
        A[:2] = 0.0
        A[:2, :2] = MINOR
    if e and sometimes(0.3):  # dependent
        A[-1] = 2 * A[0]
    if k > 2 and sometimes(0.4):
        G[-1] = G[0] + G[1]
        G[2] = -2 * G[0] if sometimes(0.5) else G[2]
    tight = rng.random(k) < 0.6
    h = G @ x + ~tight * rng.integers(1, 4, k)
    low, high, both, fixed = (rng.integers(0, 6, n) == np.arange(4)[:, None]) * 1.0
    lb = np.where(low + fixed > 0, x, np.where(both > 0, x - 1, -np.inf))
    ub = np.where(high + fixed > 0, x, np.where(both > 0, x + 2, np.inf))
    E = np.vstack([A, np.eye(n)[lb == ub]])
    B = numbers(n, int(rng.integers(0, n + 1))) * rng.integers(0, 2)
    more = numbers(n, len(E)) @ E
    P = B @ B.T + more + more.T  # v'(more) v = 0 where E v = 0
    y, z = numbers(len(E)), tight * rng.integers(0, 4, k) * rng.integers(0, 2, k)
    q = E.T @ y - G.T @ z - P @ x + low * rng.integers(0, 3, n) - high * rng.integers(0, 3, n)
    other = rng.random()
    if other < 0.06:
        q += numbers(n)
    elif other < 0.14:
        P += numbers(n, 1) + np.eye(n) * numbers(n)
        P = P + P.T
    elif k and other < 0.2:
        h[0] -= rng.integers(1, 6)
    if k and sometimes(0.05):
        h[-1] = np.inf
    return dict(zip(TERMS, (P, q, G, h, A, A @ x, lb, ub), strict=True))


def program_of_any_kind(seed):
    """A program by name, with a constant: numbers of any size come, and such as float64 rounds."""
    rng = np.random.default_rng([seed, 1])
    kind = rng.integers(4)
    program = program_on_equations(seed) if kind < 2 else random_program(seed, singular=kind == 2)
    if rng.random() < 0.1:
        program["P"] = 0 * program["P"]
    if rng.random() < 0.4:
        program = in_other_units(program, rng)
    if rng.random() < 0.1:
        share = Fraction(1, int(rng.integers(3, 50)))
        program |= {name: exact(program[name]) * share for name in ("P", "q")}
    return program | {"constant": float(rng.choice([0.0, 0.0, 1.0, -7.25, 1e9, 0.1, 1e-200]))}


def in_other_units(program, rng):
    """The same program with each x_j, each row and the cost in a unit of its own, up to 1e300.

    The powers of two are drawn until no number, and no multiplier of one, is out of 1e-300 to
    1e300; the program itself if none of many are.
    """
    n, k, e = (len(program[name]) for name in "qhb")
    for _ in range(60):
        most = rng.choice([30, 100, 300, 600, 990])
        u, v, w = (rng.integers(-most, most + 1, size) for size in (n, k, e))
        if rng.random() < 0.5:
            u[:] = u[0]  # a power that all x_j share leaves more to the rows
        s = int(rng.integers(-most, most + 1))
        powers = (s - u[:, None] - u, s - u, v[:, None] - u, v, w[:, None] - u, w, u, u)
        with np.errstate(all="ignore"):
            other = {t: np.ldexp(program[t], m) for t, m in zip(TERMS, powers, strict=True)}
        sizes = [1.0, *np.ldexp(1.0, np.clip([*(s - v), *(s - w), *(s - u), s], -1070, 1020))]
        for name, numbers in other.items():
            there = np.isfinite(program[name]) & (program[name] != 0)
            sizes += np.abs(numbers[there]).tolist()
        if min(sizes) > 1e-300 and max(sizes) < 1e300:
            return other
    return program


def sparse_program(seed, most=40):
    """A sparse program of 5 to `most` variables, most of them linear, by name.

    Some rows have one entry, none, or two limits; some equations are sums of others; some
    columns are free. A point satisfies all rows, but in a tenth.
    """
    rng = np.random.default_rng(seed)
    n = int(rng.integers(5, most + 1))
    e, k = int(rng.integers(1, n // 2 + 1)), int(rng.integers(2, n + 1))
    rows = rng.integers(-3, 4, (e + k, n)) * (rng.random((e + k, n)) < 3 / n)
    rows[rng.random(e + k) < 0.1] = 0
    single = np.flatnonzero(rng.random(e + k) < 0.2)
    rows[single] = np.eye(n, dtype=int)[rng.integers(0, n, len(single))] * 2
    A, G = rows[:e], rows[e:]
    A = np.concatenate([A, A[rng.integers(0, e, 2)] - 2 * A[rng.integers(0, e, 2)]])
    point = rng.integers(-2, 3, n)
    slack = rng.integers(0, 3, k)
    ranged = rng.random(k) < 0.3
    h = np.concatenate([G @ point + slack, 2 - (G @ point)[ranged]])
    if rng.random() < 0.1:
        h[0] -= 5
    free = rng.random(n) < 0.3
    some = (rng.random(n) < 0.1) & (rng.random() < 0.3)
    low = point - rng.integers(0, 2, n)
    G = np.concatenate([G, -G[ranged]])
    q = rng.integers(-2, 3, n) * (rng.random(n) < 0.7)
    if rng.random() < 0.8:  # the point is an optimum
        pressed = (h == G @ point) * rng.integers(0, 2, len(h))
        q = A.T @ rng.integers(-1, 2, len(A)) - G.T @ pressed - some * point
        q += (low == point) * ~free * rng.integers(0, 3, n)
    arrays = {
        "P": np.diag(some),
        "q": q,
        "G": G,
        "h": h,
        "A": A,
        "b": A @ point,
        "lb": np.where(free, -np.inf, low),
        "ub": np.where(free | (rng.random(n) < 0.5), np.inf, point + rng.integers(0, 4, n)),
    }
    return {name: array + 0.0 for name, array in arrays.items()}
