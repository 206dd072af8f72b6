"""Steps of which H is 1, and the rows are given; some have numbers that are hard to decide."""

import numpy as np

from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.tolerances import COMPLIANCE, HARDLY_MOVES

P = 2**56 - 5
"""By which zeros.c divides."""


def step_of(A, b, g, h=1.0, M=None):
    """H = M / h, or 1 / h, and A x >= b: contacts without friction; J along n is a row of A."""
    A = np.array(A, dtype=np.float64)
    m, n = A.shape
    J = np.zeros((m, 4, n))
    J[:, 2] = A
    contacts = contacts_of(-np.array(b, dtype=np.float64), np.tile(np.eye(3), (m, 1, 1)), J, 0.0)
    M = np.eye(n) if M is None else np.array(M, dtype=np.float64)
    step = free_step(M, np.array(g, dtype=np.float64), contacts, h)
    return step.replace(cone="frictionless")


def without_rows(n):
    """Loads 1, 2, ... on n coordinates that nothing couples: of other data each number differs."""
    return step_of(np.zeros((0, n)), [], np.arange(1.0, n + 1))


def half_way(k, count=1):
    """x_1 - x_2 = 1 and x_2 = k 2^-53, pressed: x_1 and A'lam are k 2^-53 and 2^-52 off 1, 2 and 3.

    These are half-way between two float64 numbers. So are the slacks of `count` contacts, far away
    and along x_2. J is 3 where it presses, so that no multiplier is half-way, too.
    """
    A = [[3.0, -3.0], [0.0, 3.0], *[[0.0, 1.0]] * count]
    return step_of(A, [3.0, 3.0 * k * 2.0**-53, *[-1.0] * count], [0.0, -6.0], 0.5)


def compliances():
    """One whose exponent is half-way between two whole numbers, and one that another side knows.

    With H = 1, J^2 is the mobility of a coordinate. That of x_1 along the second contact is less
    than HARDLY_MOVES and counts as 4 HARDLY_MOVES; that of x_2, along the first alone, is as much.
    """
    yield step_of([[float(np.sqrt(2.0**-29.5 / COMPLIANCE))]], [0.0], [-1.0])
    small = HARDLY_MOVES**0.5
    yield step_of([[1.0, small], [small / 2, 0.0]], [0.0, 0.0], [-1.0, -0.5])


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


def far(n, count):
    """Rows that are far away, along one axis after the other, and make the median length one."""
    return np.resize(np.eye(n), (count, n)).tolist(), [-9.0] * count


def without_slack():
    """Rows that nothing presses at x: some motion opens all of them, or none does.

    In this order: x_1 + x_3 / 2 is its bound, which is not zero, and the row is short; the row is
    long, so that its weight is small; of two rows with weights of a ratio of 2^45, the first gets
    none, and what opens the second does not move along it; the third is a combination of the two
    others with positive factors; the third opposes the first, and the second, nearly parallel to
    them, gets a factor of rounding.
    """
    small, large = 2.0**-35, 2.0**40
    for A, b, g in (
        ([[small, 0, small / 2]], [-small], [-0.75, 0.25, -0.5]),
        ([[large, 0]], [-large], [-1, 1]),
        ([[32, -32], [1 / large, 1 / large]], [-32, -1 / large], [-1, 0]),
        ([[1, 0], [0, 1], [-2, -1]], [0, 0, 0], [0, 0]),
        ([[0.73, 0.93], [0.87591, 1.11607], [-1.46, -1.86]], [0, 0, 0], [0, 0]),
    ):
        rows, bounds = far(len(g), 4)
        yield step_of(A + rows, b + bounds, g)


def small_numbers():
    """The first of these is not zero, the others are.

    A'lam is 2^-130 along x_2, which takes the second precision; A'lam is zero along x_2 while a row
    has no slack; x_1 is zero, as 2^-416 x_1 + x_2 is pressed as much as g_1 needs, so that many
    digits are needed.
    """
    pair = [[1, 1], [1, -1]]
    rows, bounds = far(2, 3)
    yield step_of(pair + rows, [2, 0, *bounds], [-0.75, 1], M=[[1, 2.0**-130], [2.0**-130, 1]])
    rows, bounds = far(3, 4)
    held = [[1, 1, 0], [1, -1, 0], [0, 1, 1]]
    yield step_of(held + rows, [2, 0, 0, *bounds], [-1, 1, -1])
    rows, bounds = far(2, 3)
    for power in (120, 416):
        small = 2.0**-power
        yield step_of([[small, 1], *rows], [0.75, *bounds], [-1.25 * small, -0.5])


def matrices():
    """H of an entry below 2^-840, of det H = p, and such that the last bound of errors fails.

    No coordinate of the last is zero, but the slack of a row on which nothing else depends is.
    """
    low, t, near = 2.0**-850, 2**27, 1 - 1.4 * 2.0**-46
    rows, bounds = far(2, 2)
    A = [[1, 0], [0, 2.0**-52], *rows, [1, 1]]
    yield step_of(A, [0, 1, *bounds, -9], [-1, 0], M=[[1, low], [low, 1]])
    A = [[1, 0, 0], [1, 1, 1], [0, 0, 1], [1, 1, 1]]
    M = [[4 * (t - 1), 1, 0], [1, t + 1, 0], [0, 0, 1]]
    yield step_of(A, [0, 1, 0.25, -3], [-5, -1, -1], M=M)
    yield step_of([[1, 0]], [-5], [0.75, 1], M=[[1, near], [near, 1]])
    rows, bounds = far(2, 3)
    yield step_of([[2, -1], *rows], [0, *bounds], [1, 2])


def in_units(A, b, g, rows, units):
    """H = 1 and A x >= b, of which rows and coordinates are larger by powers of two."""
    size, unit = 2.0 ** np.array(rows)[:, None], 2.0 ** np.array(units)
    near, (away, bounds) = np.array(A), far(len(g), len(A) + 1)
    return step_of(
        [*near * size * unit, *away * unit],
        [*np.array(b) * size[:, 0], *2 * np.array(bounds)],
        np.array(g) * unit,
        M=np.diag(unit**2),
    )


def bounds_decide():
    """Zeros of which float64 shows nothing but their bounds, which hang on one number each.

    In this order: the bound of a slack on the unit of a long row; those of A'lam on the row of K
    and on the column; the same of 24 coordinates, with room for two contacts only. In the last
    step x_2 rests, which a row far away couples to x_1.
    """
    yield in_units([[3, 0], [0, 3], [-1, -1]], [1, 2, -1], [0, 0], [0, 0, 40], [-20, -20])
    rows = [[0, 0, -2], [-1, 3, 2], [3, 0, 0]]
    yield in_units(rows, [2, 1, -3], [-1, 0, 3], [-40, -20, 0], [0, 15, 0])
    yield in_units([[0, 3, 0], [-3, -1, 0]], [-3, -3], [3, -1, 3], [20, 0], [0, 15, 0])
    x, n = 2.0**-30, 24
    A = [[1, 0] + [1] * n, [0, 3] + [-3] * n]
    M = np.diag([1, 1] + [1 / x**2] * n)
    yield step_of(A, [1 + n * x, 3 - 3 * n * x], [0, 0] + [1 / x] * n, M=M)
    yield step_of([[1, 0], [1, 1], [1, 0]], [1, -5, -9], [-1, 0])
