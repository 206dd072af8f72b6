"""Functions of a library that are tried alone: spans of rows, and bounds from an inverse.

A proof of a step rarely depends on the last of what they compute, so that known steps do not show
what a wrong operator does to it. Behind each array that they write stand numbers that must stay.
"""

import ctypes

import numpy as np

from quasistatic_ref.certify.dependence import follow
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.step.arrays import Array, Indices

BEHIND = 12
"""How many numbers stand behind an array."""
MARK = 77
CONES = (
    ((1, 1, 0, 0), (1, 0, 1, 0), (1, -1, 0, 0), (1, 0, -1, 0), (1, 0, 0, 1), (1, 0, 0, -1)),
    ((1, 0, 0, 0), (2, 1, 3, 0), (1, 0, 0, 2), (3, 1, 3, 2), (0, 1, 1, 1), (5, -1, 2, -3)),
    ((1 << 32, 0, 0, 0), (1 << 32, 1 << 32, 0, 0), (1 << 33, 3, 0, 0), (3, 1 << 62, 1, 0),
     (-3, 1 << 62, 0, 0), (1, 0, 0, 1 << 40)),
)  # fmt: skip
"""Rows of cones. Products of the third's do not fit into 64 bits."""
SPINS = ((1.0, 0.0, 2.0), (-1.0, 0.0, -2.0), (0.0, 1.0, 0.0), (1.0, 0.0, 2.5), (1.0, 0.0, -2.0))
MU = (0.0, 0.25, 0.5)
SPANS = 120
MOST_HELD = 6
UP = 1 + 2.0**-40
FLOOR = 2.0**-410
NORMAL = 2.0**-900
ROUNDS = 8
BOUNDS = 60
PRODUCTS = 1 << 14
LOST = 2
"""Of fixed_point.h, in a sum at most; and of proof.h, what does not fit."""


class MarkedArray:
    """An array that a function writes, and numbers behind it that it must not.

    Parameters
    ----------
    size : int
    kind : type
        float or int.
    """

    def __init__(self, size: int, kind: type) -> None:
        self.size = size
        self.all: Array = np.full(size + BEHIND, MARK, kind)
        self.address = ctypes.c_void_p(self.all.ctypes.data)

    @property
    def kept(self) -> bool:
        """Whether nothing has been written behind it."""
        return bool((self.all[self.size :] == MARK).all())


def wrong_span(library: ctypes.CDLL) -> str | None:
    """What the library finds of rows that others combine whatever J is, if it is wrong, in words.

    A row is an integer vector: how it combines the gap, the slips and the spin of its contact. With
    a friction of zero a slip or a spin is none. Spins that are equal or opposite, with one
    coefficient, are one. A row is combined if its vector is, by those of the working set.
    """
    library.unspanned.restype = ctypes.c_int64
    rng = np.random.default_rng(1)
    for case in range(SPANS):
        cone = np.array(CONES[case % 3], np.int64)
        alike = case % 2  # two contacts whose spins are one
        n_c = 2 if alike else int(rng.integers(1, 5))
        contact = np.repeat(np.arange(n_c), len(cone))
        row = np.tile(np.arange(len(cone)), n_c)
        J = rng.integers(-2, 3, (n_c, 4, 3)).astype(np.float64)
        J[:, 3] = np.array(SPINS)[rng.integers(0, 2 if alike else len(SPINS), n_c)]
        mu = np.column_stack([np.ones(n_c), *(rng.choice(MU, n_c) for _ in "abc")])
        mu[:, 1:] += 0.25 * alike * (mu[:, 1:] == 0.0)
        mu[:, 3] = mu[0, 3] if alike else mu[:, 3]
        vectors = _vectors(cone, contact, row, J[:, 3], mu)
        rows = rng.permutation(len(row))
        working: list[int] = []
        idle: list[int] = []
        for r in rows.tolist():
            small = len(working) < MOST_HELD and abs(vectors[r]).max() < 8
            free = not follow(vectors[working].tolist(), [vectors[r].tolist()])[0]
            (working if small and free else idle).append(r)
        implied = follow(vectors[working].tolist(), vectors[idle].tolist())
        right = [r for r, one in zip(idle, implied, strict=True) if not one]
        s = Structure("proof.h", "Proof")
        s.put(
            {
                "n_v": 3, "n_c": n_c, "rows": len(row), "working": len(working),
                "contact": contact, "row": row, "integers": cone, "J": J, "mu": mu,
                "guess": np.array(working, np.int64), "idle": np.array(idle, np.int64),
                "counts": np.array([len(idle), 0], np.int64),
            }
        )  # fmt: skip
        table = MarkedArray((len(working) + 1) * 4 * n_c, int)
        pivot = MarkedArray(len(working), int)
        others = MarkedArray(len(row), int)
        every = table, pivot, others
        count = library.unspanned(ctypes.c_void_p(s.address), *(one.address for one in every))
        found = others.all[:count].tolist()
        too_large = case % 3 == 2  # of products that do not fit, a row counts as not combined
        good = set(right) <= set(found) if too_large else found == right
        if not good or not all(one.kept for one in every):
            return f"of rows {idle} it combines others than {right} from {working}"
    return None


def _vectors(cone: Indices, contact: Indices, row: Indices, spins: Array, mu: Array) -> Indices:
    """The integer vector of each row, shape (m, 4 n_c)."""
    n_c = len(spins)
    owner: dict[tuple[float, ...], int] = {}
    found = np.zeros((len(row), 4 * n_c), np.int64)
    for r, (c, entry) in enumerate(zip(contact, cone[row], strict=True)):
        found[r, 3 * c : 3 * c + 3] = np.where(mu[c, :3] != 0.0, entry[:3], 0)
        sign = np.sign(spins[c][spins[c].nonzero()[0][0]])
        first = owner.setdefault((mu[c, 3], *(sign * spins[c]).tolist()), int(c))
        of_first = np.sign(spins[first][spins[first].nonzero()[0][0]])
        if mu[c, 3] != 0.0:
            found[r, 3 * n_c + first] = int(sign * of_first) * entry[3]
    return found


def wrong_bound(library: ctypes.CDLL) -> str | None:
    """What the library makes of an inverse, and of the bounds that follow from it, if it is wrong.

    The bounds must have the bits of contraction.c's formulas, which Python evaluates in the same
    order; G bounds |I - R K|, and e the error of a solution with the residuals r.
    """
    rng = np.random.default_rng(2)
    for case in range(BOUNDS):
        n = 1 + case % 6
        K = rng.standard_normal((n, n)) * 2.0 ** rng.integers(-20, 20, (n, 1))
        K[0, 0] = 0.0 if n > 1 else K[0, 0]  # the first pivot is another row's
        R = MarkedArray(n * n, float)
        pivot = MarkedArray(n, int)
        R.all[: n * n] = K.ravel()
        size = ctypes.c_int64(n)
        if not library.inverse(R.address, size, pivot.address) or not R.kept or not pivot.kept:
            return "a regular matrix has no inverse"
        inverse = R.all[: n * n].reshape(n, n)
        if not np.allclose(inverse @ K, np.eye(n), atol=1e-6):
            return "an inverse is wrong"
        inverse *= 1 + rng.choice([0.0, 1e-12, 0.02], (n, n)) * rng.standard_normal((n, n))
        G = MarkedArray(n * n, float)
        sizes = MarkedArray(n, float)
        summed = K * rng.choice([1.0, 3.0], (n, n))
        given = [array.ctypes.data_as(ctypes.c_void_p) for array in (K, summed)]
        library.defect(R.address, *given, size, G.address, sizes.address)
        if G.all[: n * n].tolist() != _defect(inverse, K, summed) or not G.kept or not sizes.kept:
            return "a bound of |I - R K| is wrong"
        r = np.abs(rng.standard_normal(n)) * rng.choice([0.0, 1e-30, 1.0], n)
        e = MarkedArray(n, float)
        shown = library.error_bounds(
            R.address, G.address, r.ctypes.data_as(ctypes.c_void_p), size, e.address
        )
        right = _error_bounds(inverse, G.all[: n * n].reshape(n, n), r)
        if (e.all[:n].tolist() if shown else None) != right or not e.kept:
            return "a bound of errors is wrong"
    empty = MarkedArray(4, float)
    empty.all[:4] = 1.0, 2.0, 2.0, 4.0  # the second row is twice the first
    if library.inverse(empty.address, ctypes.c_int64(2), MarkedArray(2, int).address):
        return "a singular matrix has an inverse"
    return None


def _defect(R: Array, K: Array, summed: Array) -> list[float]:
    found = []
    n = len(K)
    for i in range(n):
        for j in range(n):
            sum_ = size = 0.0
            for l in range(n):  # noqa: E741 the inner index of a product
                sum_ += float(R[i, l] * K[l, j])
                size += abs(float(R[i, l] * summed[l, j]))
            one = float(i == j)
            rounding = (n * 2.0**-52 + 2.0**-47) * (size + one)
            found.append((abs(one - sum_) + rounding + NORMAL) * UP)
    return found


def _error_bounds(R: Array, G: Array, r: Array) -> list[float] | None:
    n = len(r)
    e = [0.0] * n
    for i in range(n):
        for j in range(n):
            e[i] += float(abs(R[i, j]) * (abs(r[j]) + FLOOR))
        e[i] *= UP
    for _ in range(ROUNDS):
        shown = True
        for i in range(n):
            moved = 0.0
            for j in range(n):
                moved += float(G[i, j]) * e[j]
            if not moved * UP <= e[i] / 2:
                e[i] = 4 * moved
                shown = False
        if shown:
            return [2 * one for one in e]
    return None
