"""Steps of which H is 1, and the rows are given; some have numbers that are hard to decide."""

import numpy as np

from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.lab.scenes.rigid import free_step

P = 2**56 - 5
"""By which zeros.c divides."""


def step_of(A, b, g, h=1.0):
    """H = 1 / h and A x >= b: contacts without friction, of which J along n is a row of A."""
    A = np.array(A, dtype=np.float64)
    m, n = A.shape
    J = np.zeros((m, 4, n))
    J[:, 2] = A
    contacts = contacts_of(-np.array(b, dtype=np.float64), np.tile(np.eye(3), (m, 1, 1)), J, 0.0)
    step = free_step(np.eye(n), np.array(g, dtype=np.float64), contacts, h)
    return step.replace(cone="frictionless")


def half_way(k, count=1):
    """x_1 - x_2 = 1 and x_2 = k 2^-53, pressed: x_1 and A'lam are k 2^-53 and 2^-52 off 1, 2 and 3.

    These are half-way between two float64 numbers. So are the slacks of `count` contacts, far away
    and along x_2. J is 3 where it presses, so that no multiplier is half-way, too.
    """
    A = [[3.0, -3.0], [0.0, 3.0], *[[0.0, 1.0]] * count]
    return step_of(A, [3.0, 3.0 * k * 2.0**-53, *[-1.0] * count], [0.0, -6.0], 0.5)


SQUARES = (23167, 23161, 22669, 23674)
"""Their squares sum to 2^31 - 1."""


def half_way_forces(load, gap=0.0):
    """Four contacts press one coordinate, with a compliance of 2^-30 and forces load SQUARES 2^-16.

    With J = SQUARES 2^-15 they give way by x (1 + 2^30 sum J^2) = x 2^31 = -load, and a force is
    -2^30 J x. From 2^39 on, three forces of an odd load are half-way between two float64 numbers. A
    gap [m] of the first contact moves them away from there.
    """
    J = np.array(SQUARES)[:, None] * 2.0**-15
    return step_of(J, [-gap, 0.0, 0.0, 0.0], [-load])


def sevenths():
    """The optimum (5, 1/7, 1, 1, 6/7), pressed by 8/49 and 48/49, which cancel along x_1.

    The slacks of the third and the last row are zero; the last may be added to the working set: its
    multiplier is zero. Nothing but a row that is far away moves x_4, which is exact.
    """
    A = np.array([[6, 7, 0, 0, 0], [-1, 0, 0, 0, 7], [0, -8, 0, 0, -8], [8] * 5, [0, -2, 6, 0, -2]])
    return step_of(A / 8, [3.875, 0.125, -1, -9, 0.5], [5, 0, 1, 1, 0])


DIGITS_MEET = [
    ([[1.0]], [0.75]),
    ([[0.95, 1.0]], [0.8]),
    ([[2.0**-60, 0.75], [0.25, 1.0]], [1.3125, 2.0]),
    ([[0.0, 0.25], [1.0, 2.0**-60], [1.0, 0.0]], [0.25, 0.5, -5.0]),
]
"""A and b without a load: the first digit of a number is where another of the same proof ends."""


def divisible():
    """A slack of p^7 2^-836, of which the first seven digits to the base p are zero.

    It is a sum of eight numbers that are pressed, each of 49 bits and near 2^-111, times powers of
    two; and of 1/3 less 1/3, of which the error is larger. One more row is far away.
    """
    x = [float(P**7 >> 49 * i & (2**49 - 1)) * 2.0**-160 for i in range(8)]
    A = np.eye(12, 10)
    A[8:10, 8:] = 3 * np.eye(2)
    A[10] = [*(2.0 ** (49 * i - 676) for i in range(8)), 1.0, -1.0]
    A[11] = 1.0
    return step_of(A, [*x, 1.0, 1.0, 0.0, -5.0], np.zeros(10))
