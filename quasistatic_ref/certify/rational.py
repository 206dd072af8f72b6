r"""H, g, A, b formed from the step's numbers without rounding.

They are those of Eqs. :eq:`eq-1`, :eq:`eq-4`-:eq:`eq-8`, :eq:`eq-13`.

The step is what it says: float64 numbers. Everything built from them is rational; rounding it
would split the ties between the rows of a sticking contact, and the answer would then depend on
the order of summation. All quantities are brought to integers by one positive factor each,

.. math:: \delta q = u_x\,x, \qquad \lambda = u_\lambda\,y, \qquad
          \min \tfrac12 x^T H x - g^T x \quad\text{s.t.}\quad A x \ge b,

so that the exact problem is one in integers, and its answer is scaled back at the end. A finite
float64 is an integer times a power of two, and so are sums and products of such numbers: one array
of Python integers and one common exponent hold them all.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from flint import fmpq, fmpz, fmpz_mat
from numpy.typing import NDArray

from quasistatic_ref.certify.arithmetic import check_arithmetic
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, Contacts, Mask, StepData
from quasistatic_ref.step.friction import row_constants

Integers = NDArray[np.object_]
Index = int | slice | Mask | tuple[int | slice | None, ...]


@dataclass(frozen=True, eq=False)
class Dyadic:
    """The numbers ``m * 2**e``.

    Parameters
    ----------
    m : ndarray of int
        Python integers of any length.
    e : int
        Their common exponent.
    """

    m: Integers
    e: int

    def __mul__(self, other: Dyadic) -> Dyadic:
        return Dyadic(self.m * other.m, self.e + other.e)

    def __rmul__(self, number: float) -> Dyadic:
        return dyadic(number) * self

    def __matmul__(self, other: Dyadic) -> Dyadic:
        return Dyadic(self.m @ other.m, self.e + other.e)

    def __add__(self, other: Dyadic) -> Dyadic:
        e = min(self.e, other.e)
        return Dyadic(self.shifted(e) + other.shifted(e), e)

    def __sub__(self, other: Dyadic) -> Dyadic:
        return self + -other

    def __neg__(self) -> Dyadic:
        return Dyadic(-self.m, self.e)

    def __getitem__(self, index: Index) -> Dyadic:
        return Dyadic(self.m[index], self.e)

    def shifted(self, e: int) -> Integers:
        """Return the integers of the same numbers at an exponent `e`, at most their own."""
        return self.m if e == self.e else self.m * (1 << (self.e - e))


def dyadic(array: Array | float) -> Dyadic:
    """The same numbers, without rounding.

    Parameters
    ----------
    array : ndarray
        Finite float64 numbers of any shape and unit [-].

    Returns
    -------
    Dyadic
        With the largest common exponent, so that the integers are short.
    """
    fraction, exponent = np.frexp(np.asarray(array, dtype=np.float64))
    m = (fraction * 2.0**53).astype(np.int64)  # |fraction| < 1: 53 bits, without rounding
    e = exponent.astype(np.int64) - 53
    trailing = np.frexp((m & -m).astype(np.float64))[1] - 1  # trailing zero bits; -1 of a zero
    m = m >> np.maximum(trailing, 0)
    e = e + trailing
    least = int(e[m != 0].min()) if m.any() else 0
    shift = np.where(m == 0, 0, e - least)
    integers = np.empty(m.shape, dtype=object)
    flat = [a << s for a, s in zip(m.ravel().tolist(), shift.ravel().tolist(), strict=True)]
    integers.reshape(-1)[:] = flat
    return Dyadic(integers, least)


def concatenated(parts: Sequence[Dyadic], axis: int = 0) -> Dyadic:
    """Arrays of the same numbers, one after the other along an axis that they have."""
    e = min((p.e for p in parts if p.m.any()), default=0)
    aligned = [p.shifted(e) if p.m.any() else p.m for p in parts]
    return Dyadic(np.concatenate(aligned, axis=axis), e)


@dataclass(frozen=True, eq=False)
class ExactForm:
    """A quadratic program in integers, and the factors that lead back to SI units.

    Parameters
    ----------
    H, g, A, b : fmpz_mat
        Shapes (n_v, n_v), (n_v, 1), (m, n_v), (m, 1); H symmetric. The rows of A are contact-major,
        in the order of their cone's rows; the user's own rows come last.
    x_unit : fmpq
        delta_q = x_unit * x [m, rad].
    slack_unit : fmpq
        A delta_q - b = slack_unit * (A x - b) [m].
    lam_unit : fmpq
        lam = lam_unit * y [N s].
    net_unit : fmpq
        A' lam = net_unit * A' y [N s, N m s].
    """

    H: fmpz_mat
    g: fmpz_mat
    A: fmpz_mat
    b: fmpz_mat
    x_unit: fmpq
    slack_unit: fmpq
    lam_unit: fmpq
    net_unit: fmpq

    @cached_property
    def n(self) -> int:
        """Number of coordinates."""
        return self.A.ncols()

    @cached_property
    def m(self) -> int:
        """Number of rows."""
        return self.A.nrows()

    def row(self, i: int) -> list[fmpz]:
        """Return row i of A."""
        return [self.A[i, v] for v in range(self.n)]

    def rows(self, some: Iterable[int]) -> list[list[fmpz]]:
        """Return some rows of A."""
        return [self.row(i) for i in some]

    def equations(self, some: Iterable[int]) -> list[list[fmpz]]:
        """Some rows of A, and b_i after each: n + 1 numbers."""
        return [[*self.row(i), self.b[i, 0]] for i in some]


def exact_form(step: StepData) -> ExactForm:
    """H, g, A, b of a step, without rounding.

    Parameters
    ----------
    step : StepData

    Returns
    -------
    ExactForm

    Raises
    ------
    InputError
        If nothing can be proved in this thread.
    """
    of_contacts = exact_friction_rows(step.contacts, step.cone)[step.mask]
    constants = row_constants(step.contacts, step.cone)[step.mask]
    A = concatenated([of_contacts, dyadic(step.extra.A)])  # Eq. (8)
    b = concatenated([dyadic(-constants), dyadic(step.extra.b)])
    return form_on(step, A, b)


def form_on(step: StepData, A: Dyadic, b: Dyadic) -> ExactForm:
    """H and g of a step without rounding, with any rows A, shape (k, n_v), b, (k,) [of the step].

    Raises
    ------
    InputError
        If nothing can be proved in this thread.
    """
    check_arithmetic()
    # M_u / h is not dyadic, h H and h g are: Eq. (13) times h has the same minimiser.
    return in_integers(h_times_hessian(step), h_times_load(step), A, b, fraction(step.h))


def h_times_load(step: StepData) -> Dyadic:
    """The vector h g of Eq. :eq:`eq-13` without rounding, shape (n_v,)."""
    h = dyadic(step.h)
    tau_k = dyadic(step.K_q) @ dyadic(step.delta_q_bar_a)  # Eq. (1)
    return h * h * concatenated([tau_k + dyadic(step.tau_a), dyadic(step.tau_u)])  # Eq. (13)


def h_times_hessian(step: StepData) -> Dyadic:
    """The matrix h H of Eq. :eq:`eq-13` without rounding, shape (n_v, n_v); positive definite."""
    h = dyadic(step.h)
    return block_diagonal(h * h * dyadic(step.K_q), dyadic(step.M_u))  # Eq. (13)


def contact_motion(contacts: Contacts) -> Dyadic:
    """The motion along n, d1, d2 and spin per unit of delta_q, shape (n_c, 4, n_v)."""
    J = dyadic(contacts.J)
    axes = dyadic(np.stack([contacts.n, contacts.d1, contacts.d2], axis=1))
    return concatenated([axes @ J[:, :3], J[:, 3:]], axis=1)


def exact_friction_rows(contacts: Contacts, name: str) -> Dyadic:
    """The rows n~' J + d~_i' J of Eq. :eq:`eq-4`, all of each contact, shape (n_c, R, n_v)."""
    motion = contact_motion(contacts)
    friction_cone = cone(name)
    mu = dyadic(friction_cone.row_coefficients(contacts.mu))
    J_n, J_1, J_2, J_w = (motion[:, i : i + 1] for i in range(4))
    mu_v = mu[:, :1, None]
    mu_omega = mu[:, 2:, None]
    rows = friction_cone.function(J_n, mu_v * J_1, mu_v * J_2, mu_omega * J_w)  # Eqs. (4)-(7)
    return concatenated(rows, axis=1)


def block_diagonal(K: Dyadic, M: Dyadic) -> Dyadic:
    """Two square blocks, of any units, on the diagonal of a matrix of zeros."""
    beside_K = np.zeros((len(K.m), len(M.m)), dtype=object)
    above = np.hstack([K.m, beside_K])
    below = np.hstack([beside_K.T, M.m])
    return concatenated([Dyadic(above, K.e), Dyadic(below, M.e)])


def in_integers(H: Dyadic, g: Dyadic, A: Dyadic, b: Dyadic, h: fmpq) -> ExactForm:
    """The problem min 1/2 x'Hx - g'x s.t. Ax >= b in integers, from an objective times `h` [s]."""
    # Exponent of x: small enough that both g and b are integers in it.
    needed = [v.e - M.e for v, M in ((g, H), (b, A)) if v.m.any()]
    e_x = min(needed, default=0)
    g_m = g.shifted(H.e + e_x) if g.m.any() else g.m
    b_m = b.shifted(A.e + e_x) if b.m.any() else b.m
    return ExactForm(
        H=matrix(H.m),
        g=matrix(g_m[:, None]),
        A=matrix(A.m),
        b=matrix(b_m[:, None]),
        x_unit=two_to(e_x),
        slack_unit=two_to(A.e + e_x),
        lam_unit=two_to(H.e + e_x - A.e) / h,
        net_unit=two_to(H.e + e_x) / h,
    )


def matrix(m: Integers) -> fmpz_mat:
    """The same integers, of any unit [-], shape (rows, columns)."""
    return fmpz_mat(m.shape[0], m.shape[1], m.ravel().tolist())


def two_to(e: int) -> fmpq:
    """The power of two of a whole exponent [-]."""
    return fmpq(1 << max(e, 0), 1 << max(-e, 0))


def fraction(x: float) -> fmpq:
    """A float64 number, without rounding [the same unit]."""
    return fmpq(*x.as_integer_ratio())
