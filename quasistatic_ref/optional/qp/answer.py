"""What ``exact_qp`` gives: the optimum, or the proof of none; and how each is checked."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from flint import arb, arb_mat, fmpq
from numpy.typing import ArrayLike

from quasistatic_ref.certify.farkas import fractions_read
from quasistatic_ref.certify.form import EXACT, PRECISION, ExactForm, exact_matrix, fraction
from quasistatic_ref.certify.minimiser import Minimiser, rounded_quotients
from quasistatic_ref.certify.norm import digits_of_error
from quasistatic_ref.certify.verdict import Verdict, wrong_bits, wrong_claim
from quasistatic_ref.certify.verification import unique_and_smooth, wrong_sign
from quasistatic_ref.certify.working_set import Point, fraction_point
from quasistatic_ref.errors import InputError, QuasistaticError
from quasistatic_ref.files.content import text_written
from quasistatic_ref.formats.json_text import json_text
from quasistatic_ref.formats.plain import Plain, field_values
from quasistatic_ref.formats.quoting import listed
from quasistatic_ref.formats.shown import Shown
from quasistatic_ref.numbers.arrays import Array, checked_numbers
from quasistatic_ref.numbers.precision import check_arithmetic, nearest_fraction, working_precision
from quasistatic_ref.optional.qp.program import QuadraticProgram

QP_FORMAT: Final = "quasistatic-ref/qp"
VERSION: Final = 1
MOST_NAMES: Final = 8
"""Names of rows that a sentence lists."""


@dataclass(frozen=True, eq=False, repr=False)
class ExactQP(Plain, Shown):
    """The optimum of a quadratic program; every number of x, z, y and z_box is rounded correctly.

    Parameters
    ----------
    problem : QuadraticProgram
    x : ndarray, shape (n,)
    z : ndarray, shape (k,)
        Multipliers of G x <= h, none negative.
    y : ndarray, shape (e,)
        Multipliers of A x = b [objective per unit of b].
    z_box : ndarray, shape (n,)
        Multipliers of bounds, negative at lower ones: P x + q + G'z + A'y + z_box = 0.
    obj, obj_error : float
        1/2 x'Px + q'x of the exact x, and a bound of the error of `obj`.
    active : tuple of str
        Rows that hold x where it is, as ``"G[3]"``, ``"A[0]"``, ``"lb[2]"`` and ``"ub[2]"``: they
        are independent, and all others have multipliers of zero. Where lb = ub the row is lb's.
    multipliers_unique : bool
        Whether z, y and z_box are the only ones.

    Examples
    --------
    >>> answer = qr.exact_qp(np.eye(2), [-3.0, -1.0], G=[[1.0, 1.0]], h=[1.0])
    >>> answer.x.tolist(), answer.z.tolist(), answer.obj, answer.active
    ([1.5, -0.5], [1.5], -2.75, ('G[0]',))
    >>> bool(qr.verify(answer))
    True
    """

    problem: QuadraticProgram
    x: Array
    z: Array
    y: Array
    z_box: Array
    obj: float
    obj_error: float
    active: tuple[str, ...]
    multipliers_unique: bool

    def digits(self, x: ArrayLike) -> float:
        """Correct digits of somebody's x, shape (n,): 0 to 16, and 0 for what is not finite.

        -log10 of ||x - x*||_P over the longer of ||x*||_P and ||P^-1 q||_P, with
        ||v||_P^2 = v'Pv: x* is the optimum, -P^-1 q the optimum without any row.
        """
        off = _numbers(x, "x", len(self.x))
        return self._digits(
            _column(off[block.coordinates]) - _column(self.x[block.coordinates])
            for block in self.problem.blocks
        )

    def digits_of_multipliers(
        self, z: ArrayLike = (), y: ArrayLike = (), z_box: ArrayLike | None = None
    ) -> float:
        """Correct digits of somebody's multipliers, by what they do to x: 0 to 16 [-].

        As :meth:`digits`, of P^-1 (G'z + A'y + z_box): it is unique where multipliers are not.
        """
        problem = self.problem
        n = len(problem.q)
        given = {"z": z, "y": y, "z_box": np.zeros(n) if z_box is None else z_box}
        parts = [_numbers(given[name], name, size) for name, size in problem.sizes.items()]
        eye = np.eye(n)
        matrix = exact_matrix(np.concatenate([problem.G, problem.A, eye, eye]).T)
        with working_precision(EXACT):
            force = (matrix * _column(np.concatenate([*parts, problem.q]))).entries()
        return self._digits(
            block.form.H_inverse * arb_mat([[force[i]] for i in block.coordinates])
            + _column(self.x[block.coordinates])
            for block in problem.blocks
        )

    def _digits(self, errors: Iterable[arb_mat]) -> float:
        """Correct digits from the errors of each block."""
        with working_precision(PRECISION):
            off = arb(0)
            length = arb(0)
            free = arb(0)
            for block, error in zip(self.problem.blocks, errors, strict=True):
                x = _column(self.x[block.coordinates])
                off += _square(error, block.form.H * error)
                length += _square(x, block.form.H * x)
                free += _square(block.form.g, block.form.inverse(PRECISION).free)
            longer = max(length.mid(), free.mid())
            if not longer > 0:
                return digits_of_error(0.0 if off == 0 else math.inf)
            share = float((off / longer).mid())
            return digits_of_error(math.sqrt(share) if share >= 0 else math.nan)

    def save(self, path: str | Path) -> Path:
        """Write the problem and this answer as one JSON file, whole or not at all.

        ``quasistatic-ref verify FILE`` checks it, and so does ``validation/check_solution.py``.
        """
        values = field_values(self)
        return _saved(path, values.pop("problem"), {"status": "optimal"} | values)

    def verdict(self) -> Verdict:
        """Whether all numbers of the answer are proved, checked without a solver."""
        return _optimum_verdict(self)


class QPInfeasible(QuasistaticError):
    """No x satisfies the rows of a quadratic program; this is proved.

    Parameters
    ----------
    problem : QuadraticProgram
    exact : mapping of str to sequence of str
        The proof (Farkas) in fractions ``"p/q"``: z >= 0, y and z_box with G'z + A'y + z_box = 0,
        and h'z + b'y plus what z_box asks of the bounds (ub where it is positive, lb where it is
        negative) is negative.

    Attributes
    ----------
    z, y, z_box : ndarray, shapes (k,), (e,) and (n,)
        The proof, each number rounded correctly.
    rows : tuple of str
        The rows that contradict each other, as of :class:`ExactQP`.

    Examples
    --------
    >>> try:
    ...     qr.exact_qp(np.eye(1), [0.0], G=[[1.0], [-1.0]], h=[1.0, -2.0])
    ... except qr.QPInfeasible as error:
    ...     print(error.rows, error.z.tolist())
    ('G[0]', 'G[1]') [1.0, 1.0]
    """

    def __init__(self, problem: QuadraticProgram, exact: Mapping[str, Sequence[str]]) -> None:
        self.problem = problem
        self.exact = {name: tuple(exact[name]) for name in ("z", "y", "z_box")}
        self.z, self.y, self.z_box = (
            np.array([nearest_fraction(v) for v in fractions_read(texts) or []])
            for texts in self.exact.values()
        )
        self.rows = tuple(problem.rows.names[i] for i in _used_rows(problem, self.exact))
        super().__init__(
            f"the program has no solution: {self._in_words()} (proved without rounding)"
        )

    def _in_words(self) -> str:
        if len(self.rows) != 1:
            more = len(self.rows) - MOST_NAMES
            names = [*self.rows[:MOST_NAMES], *([f"{more} more rows"] if more > 0 else [])]
            return f"{listed(names or ['no rows'])} contradict each other"
        (i,) = np.flatnonzero([*self.z, *self.y])
        side = [*self.problem.h, *self.problem.b][i]
        relation = "<=" if i < len(self.z) else "="
        return f"{self.rows[0]} asks for 0 {relation} {side:.3g}"

    def save(self, path: str | Path) -> Path:
        """Write the problem and this proof as one JSON file, as of :meth:`ExactQP.save`."""
        return _saved(path, self.problem, {"status": "infeasible", "farkas": self.exact})

    def verdict(self) -> Verdict:
        """Whether the proof that there is no solution holds, checked without a solver."""
        reason = _farkas_refutation(self.problem, self.exact)
        return Verdict(not reason, reason)


@dataclass(frozen=True, eq=False)
class BlockOptimum:
    """The optimum of a block, each number rounded correctly.

    Parameters
    ----------
    working : sequence of int
        The rows of the block that hold x.
    x, y : ndarray, shapes (n,) and (k,)
        Of the block's coordinates, and the multipliers of `working` [any unit].
    objective : ndarray, shape (1,)
        Of the block alone [any unit].
    unique : bool
        Whether the multipliers are the only ones.
    """

    working: Sequence[int]
    x: Array
    y: Array
    objective: Array
    unique: bool


def double_objective(form: ExactForm, working: Sequence[int], point: Point) -> list[arb]:
    """Twice 1/2 x'Px + q'x at the minimiser on W, times the denominator: q'x - c_W'y.

    For x'Px + q'x = x'A_W'y = -c_W'y.
    """
    c = [row[-1] for row in form.exact_rows(working)]
    terms = [(form.g.entries(), point.x), (c, point.y)]
    return [-sum((u * v for us, vs in terms for u, v in zip(us, vs, strict=True)), arb(0))]


def joined(problem: QuadraticProgram, optima: Sequence[BlockOptimum]) -> dict[str, Any]:
    """The fields of an answer, but its problem, from the optima of its blocks."""
    rows = problem.rows
    x = np.zeros(len(problem.q))
    of_rows = np.zeros(len(rows.names))
    active: list[int] = []
    for block, optimum in zip(problem.blocks, optima, strict=True):
        held = block.rows[[*optimum.working]]
        x[block.coordinates] = optimum.x
        of_rows[held] = optimum.y
        active += held.tolist()
    objectives = np.concatenate([optimum.objective for optimum in optima])
    obj = math.fsum(objectives)
    return {
        "x": x,
        **problem.multipliers(of_rows),
        "obj": obj,
        "obj_error": math.fsum(np.spacing(np.abs([obj, *objectives]))),
        "active": tuple(rows.names[i] for i in sorted(active)),
        "multipliers_unique": all(optimum.unique for optimum in optima),
    }


def _optimum_verdict(answer: ExactQP) -> Verdict:
    check_arithmetic()
    problem = answer.problem
    names = problem.rows.names
    unknown = [name for name in answer.active if name not in names]
    if unknown:
        return Verdict(False, f"active names {unknown[0]!r}, which is no row of the program")
    optima = []
    for block in problem.blocks:
        form = block.form
        working = [j for j, i in enumerate(block.rows) if names[i] in answer.active]
        try:
            point = fraction_point(form, working)
        except ZeroDivisionError:
            return Verdict(False, "the active rows are not independent")
        with working_precision(EXACT):
            slack = form.slacks(range(form.m), point.z)
            double = double_objective(form, working, point)
            twice = point.denominator * 2
        wrong = wrong_sign(form, working, point.y, slack)
        if wrong is not None:
            name = names[block.rows[wrong[0]]]
            if wrong[1] == "violated":
                return Verdict(False, f"{name} is violated by the minimiser on the active rows")
            return Verdict(False, f"the multiplier of {name} is {wrong[1]}")
        left = sorted({*range(form.equations)} - {*working})
        if Minimiser(form, tuple(working)).implied(left) != left:
            return Verdict(False, "active leaves out an equation that does not follow from it")
        optimum = BlockOptimum(
            working,
            x=rounded_quotients(point.x, point.denominator),
            y=rounded_quotients(point.y, point.denominator),
            objective=rounded_quotients(double, twice),
            unique=unique_and_smooth(form, working, slack)[0],
        )
        optima.append(optimum)
    for name, right in joined(problem, optima).items():
        fault = wrong_bits if isinstance(right, np.ndarray) else wrong_claim
        if reason := fault(name, getattr(answer, name), right):
            return Verdict(False, reason)
    return Verdict(True)


def _farkas_refutation(problem: QuadraticProgram, exact: Mapping[str, Sequence[str]]) -> str:
    """What is wrong with a proof that there is no solution; empty if it holds."""
    proof = {name: fractions_read(exact[name]) for name in problem.sizes}
    for name, numbers in proof.items():
        size = problem.sizes[name]
        if numbers is None or len(numbers) != size:
            return f"{name} of the proof is no list of {size} fractions"
    if any(v < 0 for v in proof["z"] or []):
        return "z of the proof has a negative entry"
    rows = problem.rows
    used = _used_rows(problem, exact)
    if len(used) != sum(bool(v) for numbers in proof.values() for v in numbers or []):
        return "the proof uses a limit that is infinite"
    sums = [fmpq(0)] * (len(problem.q) + 1)
    for i, v in used.items():
        entries: list[float] = [*rows.a[i].tolist(), float(rows.c[i])]
        sums = [s + v * fraction(w) if w else s for s, w in zip(sums, entries, strict=True)]
    *force, limit = sums
    if any(force):
        return "G'z + A'y + z_box is not zero"
    return "" if limit < 0 else "the limits that the proof adds up are not negative"


def _used_rows(problem: QuadraticProgram, exact: Mapping[str, Sequence[str]]) -> dict[int, fmpq]:
    """The rows that a proof adds up, each with its factor: positive but that of an equation."""
    proof = fractions_read([text for texts in exact.values() for text in texts]) or []
    rows = problem.rows
    factors = {
        i: int(sign) * proof[slot]
        for i, (slot, sign) in enumerate(zip(rows.slot.tolist(), rows.sign, strict=True))
        if slot < len(proof)
    }
    return {i: v for i, v in factors.items() if v > 0 or (i < rows.equations and v)}


def _saved(path: str | Path, problem: QuadraticProgram, claims: Mapping[str, Any]) -> Path:
    arrays = {
        name: [v if math.isfinite(v) else None for v in array.tolist()]
        if array.ndim == 1
        else array
        for name, array in field_values(problem).items()
    }
    record = {"format": QP_FORMAT, "version": VERSION} | arrays | dict(claims)
    return text_written(path, json_text(record) + "\n")


def _numbers(value: ArrayLike, name: str, size: int) -> Array:
    numbers = checked_numbers(value, name, InputError).reshape(-1)
    if numbers.shape != (size,):
        raise InputError(f"must be {size} numbers", field=name, value=numbers.shape)
    return numbers


def _column(numbers: Array) -> arb_mat:
    return exact_matrix(numbers[:, None])


def _square(u: arb_mat, v: arb_mat) -> arb:
    return (u.transpose() * v)[0, 0]
