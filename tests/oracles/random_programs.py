"""Quadratic programs at random that are hard to prove: ties, dependent rows, scales, an ulp."""

import numpy as np


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
