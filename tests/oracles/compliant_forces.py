"""Contact forces by compliance in 60 digits: Newton's method on distances, and no code of ours.

The energy x'Hx / 2 - g'x + h / (2 c) sum_j d(z_j)^2 is convex, where d(z) is the distance of
z = (gap, slips, spin) from the cone K = {z : C z >= 0}. For the pyramid with torsion K is
z_0 >= max(|z_1|, |z_2|, |z_3|), and the nearest point of K is found by sorting: the largest of the
|z_i| are cut down to a common level, to which z_0 is raised.
"""

from fractions import Fraction

import mpmath as mp
import numpy as np

from tests.oracles.rational_kkt import exact
from tests.oracles.solution_truth import program

DIGITS = 60
MOST = 200
EQUAL = mp.mpf(10) ** -45


def exact_numbers(step):
    """H, g, and of each contact B, phi and friction, in fractions of the step's numbers."""
    H, g, A, b = program(step.replace(cone="ellipsoid"))  # its rows are n, d1, d2 and spin
    blocks = []
    for j, mu in enumerate(exact(step.contacts.mu)):
        own = range(4 * j, 4 * j + 4)
        rows = [[f * v for v in A[i]] for f, i in zip([1, *mu], own, strict=True)]
        blocks.append((rows, -b[4 * j], mu))
    return Fraction(step.h), H, g, blocks


def number(x):
    """A fraction to 60 digits."""
    return mp.mpf(x.numerator) / x.denominator


def raised(z):
    """What z gives way by to reach K, and the derivative of that by z (rows of a 4 x 4 matrix).

    The nearest point has level t = (z_0 + the sum of the k largest |z_i|) / (1 + k), for the k with
    which exactly these are above t.
    """
    order = sorted((1, 2, 3), key=lambda i: -abs(z[i]))
    signs = [1 if v >= 0 else -1 for v in z]
    for k in range(4):
        cut = order[:k]
        t = (z[0] + sum(abs(z[i]) for i in cut)) / (1 + k)
        if t < 0:
            continue
        if all(abs(z[i]) > t for i in cut) and all(abs(z[i]) <= t for i in order[k:]):
            break
    else:
        cut, t = [], None  # the apex: all of z goes
    s = [mp.mpf(0)] * 4
    D = mp.matrix(4, 4)
    if t is None:
        for i in range(4):
            s[i], D[i, i] = -z[i], mp.mpf(-1)
        return s, D
    if not cut:
        return s, D
    share = {0: mp.mpf(1), **{i: mp.mpf(signs[i]) for i in cut}}
    for i, sign in share.items():
        s[i] = sign * t - z[i]
        for m, other in share.items():
            D[i, m] = sign * other / (1 + len(cut)) - (i == m)
    return s, D


def forces(step, compliance):
    """(f_d1, f_d2, f_n, tau_n) of each contact, shape (n_c, 4) [N, N m], rounded from 60 digits.

    A number below 1e-40 of the largest is 0.
    """
    with mp.workdps(DIGITS):
        h, H, g, blocks = exact_numbers(step)
        c = number(Fraction(compliance))
        n = step.n_v
        H_mp = mp.matrix([[number(v) for v in row] for row in H])
        g_mp = mp.matrix([number(v) for v in g])
        B = [mp.matrix([[number(v) for v in row] for row in rows]) for rows, _, _ in blocks]
        phi = [mp.matrix([number(gap), 0, 0, 0]) for _, gap, _ in blocks]
        stiffness = number(h) / c

        def at(x):
            found = [raised(list(B_j * x + phi_j)) for B_j, phi_j in zip(B, phi, strict=True)]
            squares = sum((v * v for s, _ in found for v in s), mp.mpf(0))
            energy = (x.T * (H_mp * x / 2 - g_mp))[0] + stiffness * squares / 2
            return found, energy

        x = mp.lu_solve(H_mp, g_mp)
        found, energy = at(x)
        for _ in range(MOST):
            gradient = H_mp * x - g_mp
            K = H_mp.copy()
            for B_j, (s, D) in zip(B, found, strict=True):
                gradient -= stiffness * (B_j.T * mp.matrix(s))
                K -= stiffness * (B_j.T * D * B_j)
            way = mp.lu_solve(K, -gradient)
            slope = (gradient.T * way)[0]
            share = mp.mpf(1)
            while True:
                there, lower = at(x + share * way)
                if lower <= energy + share * slope / 10**4 or share < mp.mpf(2) ** -80:
                    break
                share /= 2
            x = x + share * way
            found = there
            energy = lower
            if mp.norm(way) <= EQUAL * (mp.norm(x) + EQUAL):
                break
        else:
            raise AssertionError("Newton's method did not end")
        wrench = np.zeros((len(blocks), 4))
        sizes = [abs(v) for s, _ in found for v in s]
        least = max(sizes, default=mp.mpf(0)) * mp.mpf(10) ** -40
        for j, ((_, _, mu), (s, _)) in enumerate(zip(blocks, found, strict=True)):
            scale = [mp.mpf(1), *map(number, mu)]
            p = [v if abs(v) > least else mp.mpf(0) for v in s]
            values = [float(f * v / c) for f, v in zip(scale, p, strict=True)]
            wrench[j] = values[1], values[2], values[0], values[3]
    assert n == len(g)
    return wrench + 0.0
