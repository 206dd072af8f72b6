"""The rows that bear at the optimum, guessed from an answer: a wrong guess costs time alone."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from importlib import import_module
from typing import Any, Final

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.exact.active_set import warm_rows
from quasistatic_ref.exact.qp.basis import basis_rows
from quasistatic_ref.exact.qp.block import Block
from quasistatic_ref.exact.qp.program import QuadraticProgram, x_of
from quasistatic_ref.exact.time_limit import check_time, time_left
from quasistatic_ref.numbers.arrays import Array, checked_numbers

NEAR: Final = 1e-6
"""Largest slack of a row that a given x seems to lie on, in natural units [-]."""
DEPENDENT: Final = 1e-9
"""Singular value of equations over the largest [-] below which some depend on others."""
MANY_VARIABLES: Final = 521
"""Variables of a linear program from which HiGHS's basis is asked first: DAQP is slow there.

Where multipliers are not unique the first guess chooses them, so smaller programs keep DAQP's."""
TOLERANCE: Final = 1e-11
"""What is asked of a backend, in natural units [-]."""


class Scaled:
    """A program in natural units: P with ones on its diagonal, rows of length one.

    `a` is the matrix of rows, in natural units [-].

    Where P has a zero there, the largest entry of the column is one. The unit of x makes the
    largest entry of q one, too; where q is zero, that of b.

    Parameters
    ----------
    P, q : ndarray, shapes (n, n) and (n,)
        P symmetric.
    a, b : ndarray, shapes (m, n) and (m,) [-]
        Of a x >= b.
    equations : int
        How many of the first rows are a x = b.
    """

    def __init__(self, P: Array, q: Array, a: Array, b: Array, equations: int) -> None:
        diagonal = P.diagonal()
        column = np.abs(a[np.count_nonzero(a, axis=1) > 1]).max(axis=0, initial=0.0)
        column[column == 0] = 1.0
        unit = 1 / np.where(diagonal > 0, np.sqrt(np.maximum(diagonal, 0)), column)
        self.P = P * np.outer(unit, unit)
        q = q * unit
        length = np.hypot.reduce(a * unit, axis=1, initial=0.0)
        self.length = np.where(length > 0, length, 1.0)
        self.a = a * unit / self.length[:, None]
        b = b / self.length
        size = np.abs(q).max() or np.abs(b).max(initial=0.0) or 1.0
        self.q = q / size
        self.b = b / size
        self.unit = unit * size
        self.equations = equations

    @property
    def finite(self) -> bool:
        """Whether all numbers are in the range of float64."""
        numbers = np.concatenate([self.a.ravel(), self.P.ravel(), self.b, self.unit])
        return bool(np.isfinite(numbers).all())

    def rows(self, x: Array, lam: Array) -> list[int]:
        """The inequalities that an answer shows to bear, from x and lam in natural units."""
        first = self.equations
        _, sizes, span = np.linalg.svd(self.a[:first], full_matrices=False)
        across = span[sizes > DEPENDENT * sizes.max(initial=0.0)]  # what equations hold
        along = self.a - self.a @ across.T @ across  # rows that depend on equations are zero
        slack = self.a @ x - self.b
        bear = warm_rows(along[first:], lam[first:], slack[first:])
        return [i + first for i in bear]

    def near(self, x: Array) -> list[int]:
        """The inequalities that x alone shows to bear, the least slack first."""
        slack = (self.a @ x - self.b)[self.equations :]
        held = np.flatnonzero(slack <= NEAR * (1 + np.abs(self.b[self.equations :])))
        nearest: list[int] = held[np.argsort(slack[held], kind="stable")].tolist()
        return [i + self.equations for i in nearest]


def by_daqp(scaled: Scaled) -> tuple[Array, Array] | None:
    """The x, (n,), and lam, (m,), of DAQP in natural units; None if it has no answer."""
    daqp = import_module("daqp")
    sense = np.zeros(len(scaled.b), np.int32)
    sense[: scaled.equations] = 5  # equations
    upper = np.where(sense == 5, scaled.b, 1e30)
    options = {"primal_tol": TOLERANCE, "dual_tol": TOLERANCE}
    if math.isfinite(left := time_left()):
        options["time_limit"] = left
    arrays = (scaled.P, scaled.q, scaled.a, upper, scaled.b)
    x, _, flag, info = daqp.solve(*map(np.ascontiguousarray, arrays), sense, **options)
    return (x, -info["lam"]) if flag == 1 else None


def by_clarabel(scaled: Scaled) -> tuple[Array, Array] | None:
    """The x, (n,), and lam, (m,), of Clarabel in natural units; None if it has no answer."""
    clarabel = import_module("clarabel")
    sparse = import_module("scipy.sparse")
    e = scaled.equations
    sizes = [(clarabel.ZeroConeT, e), (clarabel.NonnegativeConeT, len(scaled.b) - e)]
    cones = [cone(size) for cone, size in sizes if size]
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.max_threads = 1
    P = sparse.csc_matrix(np.triu(scaled.P))
    arrays = (P, scaled.q, sparse.csc_matrix(-scaled.a), -scaled.b, cones, settings)
    answer = clarabel.DefaultSolver(*arrays).solve()
    x = np.array(answer.x)
    return (x, np.array(answer.z)) if np.isfinite(x).all() else None


def by_highs(scaled: Scaled) -> tuple[Array, Array] | None:
    """The x, (n,), and lam, (m,), of HiGHS in natural units, where P is zero; else None."""
    if scaled.P.any():
        return None
    optimize = import_module("scipy.optimize")
    e = scaled.equations
    arrays = {"A_ub": -scaled.a[e:], "b_ub": -scaled.b[e:]}
    arrays |= {"A_eq": scaled.a[:e], "b_eq": scaled.b[:e]} if e else {}
    answer = optimize.linprog(scaled.q, **arrays, bounds=(None, None), method="highs-ds")
    if answer.status:
        return None
    of_equations = answer.eqlin.marginals if e else []
    return answer.x, np.append(of_equations, -answer.ineqlin.marginals)


BACKENDS: Final[tuple[Callable[[Scaled], tuple[Array, Array] | None], ...]] = (
    by_daqp,
    by_highs,
    by_clarabel,
)
"""Who is asked, the first first; one that is not installed has no answer."""


def guesses(scaled: Scaled) -> Iterator[tuple[list[int], Array]]:
    """Rows that seem to bear, and x, (n,), as each backend sees them; none is a cold start."""
    if not scaled.finite:
        return
    for answer_of in BACKENDS:
        check_time()
        with suppress(ImportError):
            answer = answer_of(scaled)
            if answer is not None:
                yield scaled.rows(*answer), answer[0] * scaled.unit


def guessed(
    program: QuadraticProgram, block: Block, initvals: Any
) -> Iterator[tuple[list[int], Array]]:
    """Rows that seem to bear, and multipliers (m,), from a start that a user gave.

    Each is the numbers of rows, and multipliers of shape (m,).

    Parameters
    ----------
    program : QuadraticProgram
    block : Block
    initvals : ndarray of shape (n,), object with x, z, y and z_box, or None
        None asks backends.

    Raises
    ------
    InputError
        If initvals is neither.
    """
    if initvals is None:
        if block.n >= MANY_VARIABLES and block.is_linear:
            with suppress(ImportError):
                basis = basis_rows(block)
                if basis is not None:
                    yield basis
        yield from guesses(_scaled(program, block))
        return
    x, lam = _given(program, initvals)
    of_block = x[block.coordinates]
    scaled = _scaled(program, block)
    if not scaled.finite:
        return
    if lam is None:
        yield scaled.near(of_block / scaled.unit), of_block
    else:
        yield scaled.rows(of_block / scaled.unit, lam[block.rows] * scaled.length), of_block


def _scaled(program: QuadraticProgram, block: Block) -> Scaled:
    P = block.square / 2 + block.square.T / 2
    q = program.q[block.coordinates]
    return Scaled(P, q, block.a, 0.0 - block.c, block.equations)


def _given(program: QuadraticProgram, initvals: Any) -> tuple[Array, Array | None]:
    """The user's initial x, and initial multipliers of each row if they are given."""
    x = x_of(initvals)
    x = checked_numbers([] if x is None else x, "initvals", InputError).reshape(-1)
    n = len(program.q)
    if x.shape != (n,) or not np.isfinite(x).all():
        problem = f"must be {n} finite numbers, or an answer that has them as its x"
        raise InputError(problem, field="initvals", value=x.shape)
    like = program.multipliers(np.zeros(len(program.rows.names)))
    given = {name: getattr(initvals, name, None) for name in like}
    if all(v is None for v in given.values()):
        return x, None
    fit = [
        np.ravel(v) if v is not None and np.size(v) == len(like[name]) else like[name]
        for name, v in given.items()
    ]
    return x, np.concatenate(fit)[program.rows.slot] * program.rows.sign
