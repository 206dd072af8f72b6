r"""The friction cones: each an object by its name, the polyhedral ones made of one function.

That of the paper is ``pyramid``, in step/pyramid.py. Such a function takes a contact's gap, slip_1,
slip_2 and spin: phi + J_n delta_q, mu_v J_1 delta_q, mu_v J_2 delta_q and mu_omega J_w delta_q,
that is, the gap after the step; and the sliding along d1 and d2 and the rotation about n, each
multiplied by its coefficient of friction. All four are lengths. The function returns what must not
be negative, one entry for each of the cone's rows. It only adds, subtracts and multiplies by
float64 numbers. Therefore it returns

- given numbers, the slacks of Eq. :eq:`eq-10`;
- given CVXPY expressions, the left sides of the constraints, Eq. :eq:`eq-4`;
- given the rows J_n, mu_v J_1, mu_v J_2 and mu_omega J_w, the rows of A, Eq. :eq:`eq-8`, in floats
  or in exact numbers (``friction_rows`` in step/standard_form.py);
- given n~, mu_v d1, mu_v d2 and [0; mu_omega], the directions n~ + d~_i of Eqs.
  :eq:`eq-5`-:eq:`eq-7`.

Multipliers >= 0 of the rows combine to a contact force inside of the cone; each function states the
inequality that these forces satisfy. Where mu_v (or mu_omega) is 0, \|f\|/mu <= f_n means f = 0. A
contact whose ``rows`` is 4 does not use mu_omega: it has the leading rows only, and a spin of zero.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

import numpy as np

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.numbers.angles import cos_sin_of_turn
from quasistatic_ref.numbers.arrays import Array, Indices, Mask, read_only
from quasistatic_ref.parts import part
from quasistatic_ref.quoting import nearest_name
from quasistatic_ref.step.pyramid import pyramid

if TYPE_CHECKING:
    import cvxpy as cp

Rows: TypeAlias = "tuple[Any, ...]"
Coefficients: TypeAlias = "tuple[tuple[float, ...], ...]"
ConeFunction: TypeAlias = "Callable[[Any, Any, Any, Any], Rows]"
Violations: TypeAlias = tuple[Array, Array, Array]
Judge: TypeAlias = Callable[[Array, Array], Violations]
Claims: TypeAlias = Mapping[str, tuple[str, ...]]

PYRAMID = "pyramid"
ELLIPSOID = "ellipsoid"
CONES = (PYRAMID, ELLIPSOID, "product", "facets-K", "frictionless")
UNITS = tuple(map(tuple, np.eye(4).tolist()))
"""The gap alone, each slip alone, and the spin alone [m]."""
MOST_FACETS = 1024
"""A polygon with more sides is within 5e-6 of the circle, and makes steps of many MB."""


@dataclass(frozen=True, eq=False)
class FrictionCone(ABC):
    """A friction cone: what a step needs to know of it.

    Parameters
    ----------
    name : str
    row_names : tuple of str
        A name for each number of lam that a contact with torsion has.
    without_torsion : int
        How many of these numbers a contact has whose mu_omega is not used.
    function : callable
        (gap, slip_1, slip_2, spin) -> the rows of a contact in A.
    """

    name: str
    row_names: tuple[str, ...]
    without_torsion: int
    function: ConeFunction
    claims: ClassVar[Claims]
    """The kinds of certificate in it, each with its further fields in a solution file."""

    @property
    @abstractmethod
    def polyhedral(self) -> bool:
        """Whether linear inequalities (rows) alone describe it."""

    @property
    def coefficients(self) -> Coefficients:
        """Those of gap, slip_1, slip_2 and spin in each row, R times 4 [-].

        They are asked of the function each time. What was once made of them is kept by them, not by
        the cone's name: a function that changes in a process, as in a notebook, is noticed.
        """
        return tuple(zip(*(self.function(*unit) for unit in UNITS), strict=True))

    @property
    def matrix(self) -> Array:
        """The coefficients, shape (R, 4) [-]; one array for the same numbers.

        The admissible (f_1, f_2, tau) at f_n = 1, in units of (mu_v, mu_v, mu_omega), are the
        convex hull of the R rows without their first entries; the limit surface is its boundary.
        """
        return _matrix(self.coefficients)

    def counts(self, rows: Indices) -> Indices:
        """How many multipliers each contact has, from its ``rows``, shape (n_c,)."""
        return np.where(has_torsion(rows), len(self.row_names), self.without_torsion)

    @abstractmethod
    def row_coefficients(self, mu: Array) -> Array:
        """Factors of the slips and the spin in A, (n_c, 3) [-, -, m], from friction `mu`."""

    @abstractmethod
    def judge(self, mu: Array) -> Judge:
        """A function that measures the violation of Eqs. :eq:`eq-10`-:eq:`eq-12`.

        Parameters
        ----------
        mu : ndarray, shape (n_c, 3)
            As of contacts.

        Returns
        -------
        callable
            As :func:`row_violations`, of all rows of A.
        """

    @abstractmethod
    def constraints(self, motion: Rows, mask: Mask) -> list[cp.Constraint]:
        """The constraints on CVXPY's gap, slip_1, slip_2 and spin [m], each (n_c,).

        Parameters
        ----------
        motion : tuple of cvxpy.Expression
        mask : ndarray of bool, shape (n_c, R)
            Which of the cone's rows each contact has.
        """

    @abstractmethod
    def multipliers(self, constraints: Sequence[cp.Constraint], mask: Mask, mu: Array) -> Array:
        """Lam of solved :meth:`constraints`, contact-major, shape (m,); `mu` as of contacts."""


@lru_cache(maxsize=64)
def _matrix(coefficients: Coefficients) -> Array:
    return read_only(np.array(coefficients))


class PolyhedralCone(FrictionCone):
    """A cone that its rows describe: the core proves its optima by exact rows."""

    polyhedral = True
    claims: ClassVar[Claims] = {
        "exact": (
            "active", "multipliers_unique", "differentiable", "smallest_inactive_slack",
            "smallest_active_multiplier", "error_bound",
        ),
        "residual": (),
        "none": (),
    }  # fmt: skip

    def row_coefficients(self, mu: Array) -> Array:
        """The coefficients of friction `mu` (n_c, 3) [-, -, m], unchanged."""
        return mu

    def judge(self, mu: Array) -> Judge:
        """The judge of rows: :func:`row_violations`, whatever `mu`, (n_c, 3) [-, -, m], is."""
        return row_violations

    def constraints(self, motion: Rows, mask: Mask) -> list[cp.Constraint]:
        """One constraint for each row, on the contacts that have it; none where no contact has.

        Parameters
        ----------
        motion : tuple of cvxpy.Expression
            gap, slip_1, slip_2 and spin [m], each (n_c,).
        mask : ndarray of bool, shape (n_c, R)
        """
        rows = zip(self.function(*motion), mask.T, strict=True)
        return [_of_contacts(has, row) >= 0 for row, has in rows if has.any()]

    def multipliers(self, constraints: Sequence[cp.Constraint], mask: Mask, mu: Array) -> Array:
        """Lam of solved constraints, shape (m,) [N s]; `mask` (n_c, R) and `mu` (n_c, 3)."""
        of_rows = np.zeros(mask.shape)
        for i, row in zip(np.flatnonzero(mask.any(axis=0)), constraints, strict=True):
            of_rows[mask[:, i], i] = row.dual_value
        return of_rows[mask]


def _of_contacts(has: Mask, row: cp.Expression) -> cp.Expression:
    """A row, (n_c,) [m], of the contacts that have it.

    By a matrix, because CVXPY prints an index of a sum without the brackets around the sum.
    """
    if has.all():
        return row
    import cvxpy as cp  # both take their time
    import scipy.sparse as sp

    return cp.Constant(sp.eye_array(len(has)).tocsr()[has], name="torsional") @ row


def row_violations(slack: Array, lam: Array) -> Violations:
    """The violation of Eqs. :eq:`eq-10`-:eq:`eq-12` in each row.

    Parameters
    ----------
    slack, lam : ndarray, shape (m,)
        A delta_q - b [m], and the multipliers [N s].

    Returns
    -------
    short, pull, work : ndarray
        How far the conditions on slacks [m] and on multipliers [N s] are violated, negative where
        they hold; and slack times multiplier [N m s].
    """
    short = -slack  # Eq. (10): slack >= 0
    pull = -lam  # Eq. (11): lam >= 0
    work = slack * lam  # Eq. (12): zero, row by row
    return short, pull, work


def has_torsion(rows: Indices) -> Mask:
    """Whether contacts use mu_omega, shape (n_c,), from their ``rows``, 6 or 4, shape (n_c,)."""
    return np.equal(rows, 6)


def product_cone(gap: Any, slip_1: Any, slip_2: Any, spin: Any) -> Rows:
    r""":math:`|f_1|/\mu_v + |f_2|/\mu_v \le f_n` and :math:`|\tau|/\mu_\omega \le f_n`.

    Tangential force and torque do not reduce each other's limit. The rows are +d1, +d2, -d1, -d2,
    each with +spin, then each with -spin, in the unit [m] of the arguments.
    """
    sliding = (slip_1, slip_2, -slip_1, -slip_2)
    return (*(gap + slip + spin for slip in sliding), *(gap + slip - spin for slip in sliding))


def frictionless(gap: Any, slip_1: Any, slip_2: Any, spin: Any) -> Rows:
    r""":math:`f_1 = f_2 = \tau = 0 \le f_n`: the gap [m] alone."""
    return (gap,)


def facets(K: int) -> ConeFunction:
    r"""The cone of a K-sided tangential pyramid: ||(f_1, f_2)||_K / mu_v + |tau| / mu_omega <= f_n.

    ||.||_K is the gauge of the regular polygon with corners on the unit circle, the first at d1.
    The gauge of a vector is at least its length and at most its length over cos(pi / K). K = 4 is
    the paper's cone, bit for bit. The corners' cosines and sines are data, rounded correctly to
    float64.

    Parameters
    ----------
    K : int
        Number of sides, even and at least 4.

    Returns
    -------
    callable
        The cone's function. It returns the sides counter-clockwise about n, then +spin, -spin, in
        the unit [m] of its arguments.
    """
    corners = [cos_sin_of_turn(k, K) for k in range(K)]

    def rows(gap: Any, slip_1: Any, slip_2: Any, spin: Any) -> Rows:
        sides = (gap + c * slip_1 + s * slip_2 for c, s in corners)
        return (*sides, gap + spin, gap - spin)

    return rows


def checked_cone(name: object) -> FrictionCone:
    """The cone with a name from a file or a user; StepDataError if there is none."""
    if not isinstance(name, str):
        problem = "must be the name of a cone, such as 'pyramid'"
        raise StepDataError(problem, field="cone", value=name)
    return cone(name)


@cache
def cone(name: str) -> FrictionCone:
    """The friction cone with a name, such as ``"pyramid"`` or ``"facets-8"``.

    Parameters
    ----------
    name : str
        ``"pyramid"``, ``"ellipsoid"``, ``"product"``, ``"facets-K"`` with K even and at least 4,
        e.g. ``"facets-8"``; or ``"frictionless"``.

    Raises
    ------
    StepDataError
        If there is no such cone.
    InputError
        If it is that of an optional part whose folder is not there.
    """
    sliding = ("+d1", "+d2", "-d1", "-d2")
    spin = ("+spin", "-spin")
    if name == PYRAMID:
        return PolyhedralCone(name, sliding + spin, 4, pyramid)
    if name == "product":
        return PolyhedralCone(name, tuple(d + s for s in spin for d in sliding), 4, product_cone)
    if name == "frictionless":
        return PolyhedralCone(name, ("n",), 1, frictionless)
    if name == ELLIPSOID:
        ellipsoid: FrictionCone = part("ellipsoid")
        return ellipsoid
    prefix, _, sides = str(name).partition("-")
    if prefix == "facets" and sides.isascii() and sides.isdecimal() and str(int(sides)) == sides:
        K = int(sides)
        if K % 2 == 0 and 4 <= K <= MOST_FACETS:
            return PolyhedralCone(name, tuple(f"side {k}" for k in range(K)) + spin, K, facets(K))
    problem = f"must be one of {', '.join(CONES)}, with K even and 4 to {MOST_FACETS}"
    raise StepDataError(f"{problem}{nearest_name(str(name), CONES)}", field="cone", value=name)
