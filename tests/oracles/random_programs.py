"""Quadratic programs at random that are hard to prove: ties, dependent rows, scales, an ulp."""

import numpy as np


def random_program(seed):
    """The P, q, G, h, A, b, lb, ub of a program, by name; some have no solution."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 6))
    whole_numbers = rng.random() < 0.5

    def numbers(*shape):
        if whole_numbers:
            return rng.integers(-3, 4, shape).astype(float)
        return rng.normal(size=shape)

    B = numbers(n, n)
    P = B @ B.T + np.eye(n)
    if rng.random() < 0.3:  # nearly singular: the last pivot is 2^-40 or so
        B = rng.integers(-3, 4, (n, n)).astype(float)
        B[-1] = B[:-1].sum(axis=0)
        P = B @ B.T + np.diag([1.0] * (n - 1) + [2.0 ** -rng.integers(30, 48)])
        if n > 1:
            P[:-1, :-1] -= np.eye(n - 1)
            P += np.diag([2.0**-45] * n)
    if rng.random() < 0.2:  # nothing couples the parts
        P[: n // 2, n // 2 :] = 0
        P[n // 2 :, : n // 2] = 0
    k, e = int(rng.integers(0, 9)), int(rng.integers(0, 3))
    x = numbers(n)
    G, A = numbers(k, n), numbers(e, n)
    h = G @ x + (
        rng.integers(0, 2, k) if whole_numbers else rng.exponential(size=k) * rng.integers(0, 2, k)
    )
    b = A @ x
    if k and rng.random() < 0.3:  # rows that are there twice, or follow from others
        G = np.concatenate([G, G[:1], G[:1] + G[-1:], np.zeros((1, n))])
        h = np.concatenate([h, h[:1], h[:1] + h[-1:], [0.0]])
    if e and rng.random() < 0.5:
        A = np.concatenate([A, 2 * A[:1], A.sum(axis=0, keepdims=True)])
        b = np.concatenate([b, 2 * b[:1], [b.sum()]])
    ulp = rng.random() < 0.15
    if ulp and len(b):  # one equation contradicts its double
        A = np.concatenate([A, 4 * A[-1:]])
        b = np.append(b, 4 * np.nextafter(b[-1], np.inf))
    elif ulp and k:  # one inequality contradicts another
        G = np.concatenate([G, -G[:1]])
        h = np.append(h, -np.nextafter(h[0], np.inf))
    lb, ub = np.full(n, -np.inf), np.full(n, np.inf)
    if rng.random() < 0.5:
        low, high = rng.random(n) < 0.5, rng.random(n) < 0.5
        lb[low] = np.floor(x[low])
        ub[high] = np.ceil(x[high]) + rng.integers(0, 2, high.sum())
    q = numbers(n) * rng.choice([0.0, 1.0, 1.0, 10.0])
    if rng.random() < 0.3:
        u, v, w, s = 2.0 ** rng.integers(-110, 111, 4)  # of x, of rows, of equations and of P
        P, q = P * s, q * s * u
        G, A = G * v, A * w
        h, b, lb, ub = h * v * u, b * w * u, lb * u, ub * u
    if rng.random() < 0.1:
        h[: len(h) // 2] = np.inf
    return {"P": P, "q": q, "G": G, "h": h, "A": A, "b": b, "lb": lb, "ub": ub}
