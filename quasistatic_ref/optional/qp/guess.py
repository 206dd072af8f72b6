"""The rows that bear at the optimum, guessed from an answer: a wrong guess costs time alone."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any, Final

import numpy as np

from quasistatic_ref.certify.active_set import warm_rows
from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import Array, checked_numbers
from quasistatic_ref.optional.qp.form import Block
from quasistatic_ref.optional.qp.program import QuadraticProgram

NEAR: Final = 1e-6
"""Largest slack of a row that a given x seems to lie on, in natural units [-]."""
TOLERANCE: Final = 1e-11
"""What is asked of a backend, in natural units [-]."""


class Scaled:
    """The program of a block in natural units: P with ones on its diagonal, rows of length one.

    The unit of x makes the largest entry of q one, too; where q is zero, that of b.

    Parameters
    ----------
    program : QuadraticProgram
    block : Block
    """

    def __init__(self, program: QuadraticProgram, block: Block) -> None:
        at = block.coordinates
        P = program.P[np.ix_(at, at)]
        self.P = P / 2 + P.T / 2
        unit = 1 / np.sqrt(np.diag(self.P))
        self.P *= np.outer(unit, unit)
        q = program.q[at] * unit
        a, b = block.form.inequalities
        length = np.hypot.reduce(a * unit, axis=1, initial=0.0)
        self.length = np.where(length > 0, length, 1.0)
        self.a = a * unit / self.length[:, None]
        b = b / self.length
        size = np.abs(q).max() or np.abs(b).max(initial=0.0) or 1.0
        self.q = q / size
        self.b = b / size
        self.unit = unit * size
        self.equations = block.form.equations

    def rows(self, x: Array, lam: Array) -> list[int]:
        """The inequalities that an answer shows to bear, from x and lam in natural units."""
        first = self.equations
        across, _ = np.linalg.qr(self.a[:first].T)
        along = self.a - self.a @ across @ across.T  # rows that depend on equations are zero
        slack = self.a @ x - self.b
        bear = warm_rows(along[first:], lam[first:], slack[first:])
        return [i + first for i in bear]

    def near(self, x: Array) -> list[int]:
        """The inequalities that x alone shows to bear, with least-squares multipliers."""
        slack = self.a @ x - self.b
        held = np.flatnonzero(slack <= NEAR * (1 + np.abs(self.b)))
        lam = np.zeros(len(self.b))
        lam[held] = np.linalg.lstsq(self.a[held].T, self.P @ x + self.q)[0]
        return self.rows(x, lam)


def by_daqp(scaled: Scaled) -> tuple[Array, Array] | None:
    """The x, (n,), and lam, (m,), of DAQP in natural units; None if it has no answer."""
    daqp = import_module("daqp")
    sense = np.zeros(len(scaled.b), np.int32)
    sense[: scaled.equations] = 5  # equations
    upper = np.where(sense == 5, scaled.b, 1e30)
    options = {"primal_tol": TOLERANCE, "dual_tol": TOLERANCE}
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


BACKENDS: Final[tuple[Callable[[Scaled], tuple[Array, Array] | None], ...]] = (by_daqp, by_clarabel)
"""Who is asked, the first first; one that is not installed has no answer."""


def guessed(program: QuadraticProgram, block: Block, initvals: Any) -> list[int]:
    """Rows of a block that seem to bear; none is a cold start.

    Parameters
    ----------
    program : QuadraticProgram
    block : Block
    initvals : ndarray of shape (n,), object with x, z, y and z_box, or None
        None asks a backend.

    Raises
    ------
    InputError
        If initvals is neither.
    """
    with np.errstate(all="ignore"):
        scaled = Scaled(program, block)
        if not np.isfinite(np.concatenate([scaled.a.ravel(), scaled.P.ravel(), scaled.b])).all():
            return []  # out of the range of float64
        if initvals is None:
            return _asked(scaled)
        x, lam = _given(program, initvals)
        x = x[block.coordinates] / scaled.unit
        if lam is None:
            return scaled.near(x)
        return scaled.rows(x, lam[block.rows] * scaled.length)


def _asked(scaled: Scaled) -> list[int]:
    for answer_of in BACKENDS:
        try:
            answer = answer_of(scaled)
        except ImportError:
            continue
        if answer is not None:
            return scaled.rows(*answer)
    return []


def _given(program: QuadraticProgram, initvals: Any) -> tuple[Array, Array | None]:
    """The user's initial x, and initial multipliers of each row if they are given."""
    x = getattr(initvals, "x", initvals)
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
