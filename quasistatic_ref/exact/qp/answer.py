"""What ``exact_qp`` gives: the optimum, or the proof that there is none."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar, Final

import numpy as np
from flint import fmpq
from numpy.typing import ArrayLike

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.exact.fractions import fractions_read
from quasistatic_ref.exact.qp.digits import correct_digits, multiplier_digits
from quasistatic_ref.exact.qp.numbers import texts
from quasistatic_ref.exact.qp.program import FIELDS, HasAnswer, QuadraticProgram, x_of
from quasistatic_ref.exact.qp.substitution import exact_point, optimum_verdict
from quasistatic_ref.exact.qp.verdict import Proof, row_factors
from quasistatic_ref.exact.verdict import Verdict
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import nearest_fraction
from quasistatic_ref.quoting import counted, listed
from quasistatic_ref.shown import Shown
from quasistatic_ref.text.content import text_written
from quasistatic_ref.text.json_text import json_text
from quasistatic_ref.text.plain import Plain, field_values

QP_FORMAT: Final = "quasistatic-ref/qp"
VERSION: Final = 2
MOST_NAMES: Final = 8
"""Names of rows that a sentence lists."""
INFINITE: Final = 1e20
"""What other solvers take for infinite [any unit]."""
MOST_TERMS: Final = 6
"""Terms of a direction that a sentence shows."""


@dataclass(frozen=True, eq=False, repr=False)
class ExactQP(Plain, Shown):
    """The optimum of a quadratic program, each number of x, z, y, z_box and obj rounded correctly.

    ``exact_qp`` makes it; its constructor checks nothing.

    Of several optima, x is the one of least norm.

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
        1/2 x'Px + q'x of the exact x and the constant, and a bound of what rounding changes in it.
    active : tuple of str
        Rows that bear, as ``"G[3]"``, ``"A[0]"``, ``"lb[2]"`` and ``"ub[2]"``: they are
        independent, and all others have multipliers of zero. Where lb = ub the row is lb's.
    multipliers_unique : bool
        Whether z, y and z_box are the only ones.
    least_norm : tuple of str
        Further rows that hold x where it is among several optima.
    direction : tuple of str
        Whole numbers, n of them, that lead from x to other optima; empty if there are none.

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
    least_norm: tuple[str, ...] = ()
    direction: tuple[str, ...] = ()

    def __repr__(self) -> str:
        rows = counted(len(self.active), "active row")
        return f"<{type(self).__name__}: exact, {rows}, obj {self.obj:.5g}>"

    @property
    def x_unique(self) -> bool:
        """Whether x is the only optimum."""
        return not self.direction

    @property
    def remark(self) -> str:
        """A warning about a limit such as 1e30 that holds x, and that others take for infinite."""
        rows = self.problem.rows
        far = {
            name: abs(c) for name, c in zip(rows.names, rows.c, strict=True) if abs(c) >= INFINITE
        }
        held = [name for name in (*self.active, *self.least_norm) if name in far]
        if not held:
            return ""
        return f"{held[0]} holds x: {far[held[0]]:g} is a number here; write inf for no limit"

    def digits(self, x: ArrayLike | HasAnswer) -> float:
        """Correct digits of an x, shape (n,), or of an answer's: 0 to 16, 0 if it is not finite.

        Where P is positive definite: -log10 of ||x - x*||_P over the longer of ||x*||_P and
        ||P^-1 q||_P, with ||v||_P^2 = v'Pv; x* is the optimum, -P^-1 q the optimum without any
        row. Elsewhere the largest counts of ||x - x*||_P, of what x costs more by its slope, and of
        the violations of rows, each over the size of its terms at x* (where these are zero, in
        units that change the cost by its terms): all optima have 16 digits.
        """
        return correct_digits(self.problem, self.x, x_of(x))

    def digits_of_multipliers(
        self, z: ArrayLike | None = (), y: ArrayLike | None = (), z_box: ArrayLike | None = ()
    ) -> float:
        """Correct digits of multipliers, 0 to 16 [-]; empty ones are zero.

        Where P is positive definite, by what they do to x: as :meth:`digits`, of
        P^-1 (G'z + A'y + z_box), which is unique where multipliers are not. Elsewhere by the
        largest of the residual of P x* + q + G'z + A'y + z_box = 0, of wrong signs, and of the
        gap, each over the size of its terms.
        """
        given = {"z": z, "y": y, "z_box": z_box}
        return multiplier_digits(self.problem, vars(self), self._exact_x, given)

    @cached_property
    def _exact_x(self) -> list[fmpq]:
        return exact_point(self.problem, field_values(self))[0]

    def save(self, path: str | Path) -> Path:
        """Write the problem and this answer as one JSON file, whole or not at all.

        ``quasistatic-ref verify FILE`` checks it, and so does ``validation/check_solution.py``.
        """
        values = field_values(self)
        return _saved(path, values.pop("problem"), {"status": "optimal"} | values)

    def verdict(self) -> Verdict:
        """Whether all numbers of the answer are proved, checked without a solver."""
        claims = field_values(self)
        return optimum_verdict(replace(claims.pop("problem")), claims)


class NoOptimum(QuasistaticError):
    """A program has no optimum, which is proved.

    Attributes
    ----------
    problem : QuadraticProgram
    status : str
    claims : mapping of str to object
        The proof, as it stands in a file.
    """

    status: ClassVar[str]
    _refuted: ClassVar[Callable[..., str]]
    """What is wrong with the claims, which follow the :class:`Proof`."""
    problem: QuadraticProgram
    claims: Mapping[str, Any]

    def save(self, path: str | Path) -> Path:
        """Write the problem and this proof as one JSON file, as of :meth:`ExactQP.save`."""
        return _saved(path, self.problem, {"status": self.status, **self.claims})

    def verdict(self) -> Verdict:
        """Whether the proof holds, checked without a solver."""
        reason = type(self)._refuted(Proof(replace(self.problem)), *self.claims.values())
        return Verdict(not reason, reason)


class QPInfeasible(NoOptimum):
    """No x satisfies the rows of a quadratic program; this is proved.

    Parameters
    ----------
    problem : QuadraticProgram
    exact : mapping of str to str
        The proof (Farkas): by row a factor ``"p/q"``, positive but of equations. G x <= h,
        A x = b, -x <= -lb and x <= ub times these add up to 0 <= a negative number.

    Attributes
    ----------
    z, y, z_box : ndarray, shapes (k,), (e,) and (n,)
        The proof as multipliers, each number rounded correctly.
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

    status = "infeasible"
    _refuted = Proof.infeasible

    def __init__(self, problem: QuadraticProgram, exact: Mapping[str, str]) -> None:
        self.problem = problem
        self.exact = dict(exact)
        self.claims = {"farkas": self.exact}
        names = problem.rows.names
        self.rows = tuple(name for name in names if name in exact)
        factors = np.zeros(len(names))
        for i, v in row_factors(names, exact).items():
            factors[i] = nearest_fraction(v)
        multipliers = problem.multipliers(factors)
        self.z, self.y, self.z_box = multipliers["z"], multipliers["y"], multipliers["z_box"]
        super().__init__("the program has no solution")

    def __str__(self) -> str:
        if reason := self.verdict().reason:
            return f"the program is said to have no solution, but {reason}"
        return f"the program has no solution: {self._in_words()} (proved without rounding)"

    def _in_words(self) -> str:
        rows = self.problem.rows
        places = [rows.names.index(name) for name in self.rows]
        if len(places) == 1 and not rows.entries.counts[places].any():
            (i,) = places
            side = rows.c[i] if rows.names[i][0] == "G" else -rows.c[i]
            return f"{self.rows[0]} asks for 0 {'=' if i < rows.equations else '<='} {side:.3g}"
        more = len(self.rows) - MOST_NAMES
        names = [*self.rows[:MOST_NAMES], *([f"{more} more rows"] if more > 0 else [])]
        missed, largest = self._missed(places)
        ulps = missed / np.spacing(largest)
        by = f"{missed:.2g}"
        if ulps < MOST_ULPS:
            by += f", {ulps:.2g} ulps of {largest:.3g}"
            if not self.problem.exact:  # else these are the decimals
                by += ": decimals, as texts, may have a solution"
        return f"{listed(names)} contradict each other by {by}"

    def _missed(self, places: Sequence[int]) -> tuple[float, float]:
        """By how much the limits miss, and the largest number of the rows."""
        rows = self.problem.rows
        _, total = Proof(self.problem).block.combined(row_factors(rows.names, self.exact))
        named = rows.entries.some(np.array(places), np.arange(rows.entries.n))
        largest = max(np.abs(named.value).max(initial=0.0), np.abs(rows.c[places]).max())
        return abs(nearest_fraction(total)), float(largest)


MOST_ULPS: Final = 1e4
"""Units in the last place up to which rounding may be what makes rows contradict each other."""


class QPUnbounded(NoOptimum):
    """The cost of a quadratic program falls without end; this is proved.

    Parameters
    ----------
    problem : QuadraticProgram
    exact_x, exact_direction : sequence of str
        A feasible x, and a direction from it that no row ends and along which the cost falls
        without end, n fractions ``"p/q"`` each.

    Attributes
    ----------
    x, direction : ndarray, shape (n,)
        Each number rounded correctly.

    Examples
    --------
    >>> try:
    ...     found = qr.exact_qp(np.zeros((2, 2)), [1.0, -1.0], lb=[0.0, 0.0])
    ... except qr.QPUnbounded as error:
    ...     print(error.direction.tolist())
    [0.0, 0.5]
    """

    status = "unbounded"
    _refuted = Proof.unbounded

    def __init__(
        self, problem: QuadraticProgram, exact_x: Sequence[str], exact_direction: Sequence[str]
    ) -> None:
        self.problem = problem
        self.exact_x, self.exact_direction = tuple(exact_x), tuple(exact_direction)
        self.claims = {"x": self.exact_x, "direction": self.exact_direction}
        self.x, self.direction = _rounded(exact_x), _rounded(exact_direction)
        super().__init__(
            f"the cost falls without end along {_direction_in_words(exact_direction)} "
            "(proved without rounding)"
        )


class QPNotConvex(NoOptimum):
    """P has a direction that equations leave and that costs less than nothing; this is proved.

    Parameters
    ----------
    problem : QuadraticProgram
    exact_direction : sequence of str
        v with v'Pv < 0, A v = 0 and v_i = 0 where lb_i = ub_i, n whole numbers.

    Attributes
    ----------
    direction : ndarray, shape (n,)
        Each number rounded correctly.

    Examples
    --------
    >>> try:
    ...     qr.exact_qp([[1.0, 2.0], [2.0, 1.0]], [0.0, 0.0])
    ... except qr.QPNotConvex as error:
    ...     print(error.direction.tolist())
    [1.0, -1.0]
    """

    status = "not convex"
    _refuted = Proof.not_convex

    def __init__(self, problem: QuadraticProgram, exact_direction: Sequence[str]) -> None:
        self.problem = problem
        self.exact_direction = tuple(exact_direction)
        self.claims = {"direction": self.exact_direction}
        self.direction = _rounded(exact_direction)
        costs = f"{_direction_in_words(exact_direction)} costs less than nothing"
        if problem.exact:  # nothing is rounded
            super().__init__(f"P is not convex: {costs}")
        else:
            super().__init__(
                f"P as float64 holds it is not convex: {costs}; exact_ls takes factors of P, which "
                "rounding does not bend, and exact_qp decimals as texts"
            )


Answer = ExactQP | NoOptimum


def _rounded(exact: Sequence[str]) -> Array:
    return np.array([nearest_fraction(v) for v in fractions_read(exact) or []])


def _direction_in_words(direction: Sequence[str]) -> str:
    """A direction as ``x_3 - x_7``."""
    named = [(i, v) for i, v in enumerate(fractions_read(direction) or []) if v]
    words = ""
    for i, v in named[:MOST_TERMS]:
        share = nearest_fraction(v / abs(named[0][1]))
        factor = "" if abs(share) == 1 else f"{abs(share):.6g} "
        words += f" {'-' if share < 0 else '+'} {factor}x_{i}"
    return words.removeprefix(" + ").strip() + (" + ..." if len(named) > MOST_TERMS else "")


def _saved(path: str | Path, problem: QuadraticProgram, claims: Mapping[str, Any]) -> Path:
    values = field_values(problem)
    exact = values["exact"]
    arrays: dict[str, Any] = {name: texts(values[name], exact.get(name, {})) for name in FIELDS}
    arrays["constant"] = texts(np.array([problem.constant]), exact.get("constant", {}))[0]
    record = {"format": QP_FORMAT, "version": VERSION} | arrays | dict(claims)
    return text_written(path, json_text(record) + "\n")
