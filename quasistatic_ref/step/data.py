"""One step of the model as data: everything that its quadratic program is made of.

Conventions: coordinates are in the paper's order, q = [q_a; q_u]; positions, normals and
tangents are in the world frame; SI units. The JSON form is version 1 of ``quasistatic-ref/step``.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property, lru_cache
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Protocol, Self

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import StepDataError, check_kind
from quasistatic_ref.numbers.arrays import (
    Array,
    Indices,
    Mask,
    check_and_freeze,
    checked_array,
    checked_names,
    checked_numbers,
    column_count,
    read_only,
)
from quasistatic_ref.numbers.pivots import positive_definite, positive_sum, symmetric
from quasistatic_ref.shown import HasPage, Shown
from quasistatic_ref.step.cones import PYRAMID, checked_cone
from quasistatic_ref.step.cones import cone as cone_of
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.hessian import Hessian
from quasistatic_ref.text.plain import Plain, field_values

__all__ = ["Contacts", "Extra", "StepData"]


@dataclass(frozen=True, eq=False, repr=False)
class Extra(Plain, Shown):
    """Linear inequalities of the user's own, A delta_q >= b, and a quadratic cost.

    Parameters
    ----------
    names : tuple of str, length m
    A : ndarray, shape (m, n_v)
    b : ndarray, shape (m,)
    H : ndarray, shape (n_v, n_v), optional
        Of the cost 1/2 delta_q'H delta_q - g'delta_q, which is added to Eq. :eq:`eq-13`. Symmetric,
        none of its diagonal entries negative. H and g are both None where there is no cost; where
        one of them is left out, it is zero.
    g : ndarray, shape (n_v,), optional

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> limit = qr.Extra(names=("ceiling",), A=[[0, 0, -1, 0, 0, 0]], b=[-1e-5])
    >>> bool(qr.solve_step(step.replace(extra=limit)).delta_q[2] <= 1e-5)
    True
    """

    names: tuple[str, ...]
    A: Array
    b: Array
    H: Array | None = None
    g: Array | None = None

    if TYPE_CHECKING:  # what is made of lists, too

        def __init__(
            self,
            names: Sequence[str],
            A: ArrayLike,
            b: ArrayLike,
            H: ArrayLike | None = None,
            g: ArrayLike | None = None,
        ) -> None: ...

    def __post_init__(self) -> None:
        object.__setattr__(self, "names", checked_names(self.names, "extra.names"))
        n_v = column_count(self.A, "extra.A", 2)
        m = len(self.names)
        check_and_freeze(self, {"A": (m, n_v), "b": (m,)}, "extra.")
        if self.H is None and self.g is None:
            return
        for key, shape in {"H": (n_v, n_v), "g": (n_v,)}.items():
            if getattr(self, key) is None:
                object.__setattr__(self, key, np.zeros(shape))
            check_and_freeze(self, {key: shape}, "extra.")
        assert self.H is not None
        object.__setattr__(self, "H", read_only(symmetric("extra.H", self.H)))
        if (np.diag(self.H) < 0).any():
            problem = "must have no negative diagonal entry: a cost must be convex"
            raise StepDataError(problem, field="extra.H", value=np.diag(self.H).tolist())

    @cached_property
    def cost(self) -> tuple[Array, Array] | None:
        """H, shape (n_v, n_v), and g, shape (n_v,), of the cost; None where there is none."""
        return None if self.H is None or self.g is None else (self.H, self.g)

    @property
    def empty(self) -> bool:
        """Whether there are neither rows nor a cost."""
        return not self.names and self.cost is None

    def of(self, rows: Indices, coordinates: Indices) -> Extra:
        """Some rows, shape (k,), and the cost, of some coordinates alone, shape (n,)."""
        if self.empty:
            return no_extra(len(coordinates))
        cost = self.cost
        return Extra(
            tuple(self.names[i] for i in rows),
            self.A[np.ix_(rows, coordinates)],
            self.b[rows],
            H=None if cost is None else cost[0][np.ix_(coordinates, coordinates)],
            g=None if cost is None else cost[1][coordinates],
        )


@lru_cache(maxsize=8)
def no_extra(n_v: int) -> Extra:
    """No rows of the user's own, of n_v coordinates."""
    return Extra((), np.zeros((0, n_v)), np.zeros(0))


class RowLayout(NamedTuple):
    """Which rows of the cone the contacts have, and where those stand in A, b and lam.

    Parameters
    ----------
    counts : ndarray of int, shape (n_c,)
        Number of multipliers of each contact; in a polyhedral cone, of rows.
    mask : ndarray of bool, shape (n_c, R)
        Which of the cone's rows each contact has.
    offsets : ndarray of int, shape (n_c + 1,)
        Where each contact's rows start.
    """

    counts: Indices
    mask: Mask
    offsets: Indices


@lru_cache(maxsize=32)
def row_layout(cone_name: str, rows: bytes) -> RowLayout:
    """The layout of contacts in a cone, from the bytes of their ``rows``."""
    counts = cone_of(cone_name).counts(np.frombuffer(rows, np.int64))
    mask = np.arange(len(cone_of(cone_name).row_names)) < counts[:, None]
    offsets = np.concatenate([[0], np.cumsum(counts)])
    return RowLayout(read_only(counts), read_only(mask), read_only(offsets))


class FormedStep(Protocol):
    """What compiled code has formed of a step, of which contacts are made when they are read."""

    @property
    def contacts(self) -> Contacts:
        """The contacts of the step."""

    @property
    def deepest(self) -> float:
        """Depth of the deepest penetration; negative if there is none [m]."""

    def is_like(self, other: FormedStep | None) -> bool:
        """Whether another step is of the same run, so that it differs in numbers alone."""


@dataclass(frozen=True, eq=False, init=False, repr=False)
class StepData(Plain, HasPage):
    """Everything that Eq. :eq:`eq-13` needs.

    Parameters
    ----------
    h : float
        Time step [s], > 0.
    K_q : ndarray, shape (n_a, n_a)
        Stiffness of the actuated coordinates [N/m, N m/rad], symmetric positive definite.
    M_u : ndarray, shape (n_u, n_u)
        Un-actuated block of the mass matrix [kg, kg m, kg m^2], symmetric positive definite.
    tau_a : ndarray, shape (n_a,)
        Generalised force on the actuated coordinates, without that of the springs [N, N m].
    tau_u : ndarray, shape (n_u,)
        Generalised force on the un-actuated coordinates [N, N m].
    delta_q_bar_a : ndarray, shape (n_a,)
        Desired change of the actuated coordinates: target (-) q_a [m, rad].
    contacts : Contacts
        The contact points considered.
    cone : str
        Friction cone; ``"pyramid"`` is the paper's. See :mod:`~quasistatic_ref.step.cones`.
    extra : Extra, optional
        Further rows, and a quadratic cost; none by default.

    Raises
    ------
    StepDataError
        If a shape is wrong, a number is not finite, or H is not positive definite.

    Attributes
    ----------
    hessian : Hessian
        H without a user's cost, which steps of one run share; M_u is formed of it when it is read.
    formed : FormedStep or None
        What compiled code has formed of it.

    Notes
    -----
    Each field is checked, and copied read-only. What a simulator has formed is right by
    construction, and only looked at for numbers that are not finite.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> step.n_v, step.contacts.n_c, step.replace(h=0.02).h
    (6, 1, 0.02)
    """

    h: float
    K_q: Array
    M_u: Array
    tau_a: Array
    tau_u: Array
    delta_q_bar_a: Array
    contacts: Contacts
    cone: str
    extra: Extra
    if TYPE_CHECKING:
        hessian: Hessian

    def __init__(
        self,
        h: float,
        K_q: ArrayLike,
        M_u: ArrayLike,
        tau_a: ArrayLike,
        tau_u: ArrayLike,
        delta_q_bar_a: ArrayLike,
        contacts: Contacts,
        cone: str = PYRAMID,
        extra: Extra | None = None,
    ) -> None:
        checked_cone(cone)  # refuses a name that it does not know
        check_kind(contacts, Contacts, "contacts", "Contacts")
        check_kind(extra, Extra | None, "extra", "an Extra")
        # Of three that have one length, two outvote the third, which is then refused by its name.
        of_a = {"K_q": K_q, "tau_a": tau_a, "delta_q_bar_a": delta_q_bar_a}
        n_a = sorted(_lengths(of_a))[1]
        n_u = sorted([*_lengths({"M_u": M_u, "tau_u": tau_u}), contacts.n_v - n_a])[1]
        n_v = n_a + n_u
        extra = no_extra(n_v) if extra is None else extra
        for key, columns in (("contacts.J", contacts.n_v), ("extra.A", extra.A.shape[1])):
            if columns != n_v:
                problem = f"must have n_a + n_u = {n_v} columns"
                raise StepDataError(problem, field=key, value=columns)
        h = seconds(h)
        K_q = checked_array(K_q, "K_q", (n_a, n_a))
        M_u = checked_array(M_u, "M_u", (n_u, n_u))
        fields = {
            "contacts": contacts,
            "cone": cone,
            "extra": extra,
            "h": h,
            "tau_a": tau_a,
            "tau_u": tau_u,
            "delta_q_bar_a": delta_q_bar_a,
        }
        self.__dict__.update(fields)
        check_and_freeze(self, {"tau_a": (n_a,), "tau_u": (n_u,), "delta_q_bar_a": (n_a,)})
        K_q = positive_definite("K_q", K_q)
        hessian = Hessian(h, K_q, positive_definite("M_u", M_u))
        self.__dict__.update(K_q=K_q, hessian=hessian)
        if extra.cost is not None and not self._definite_with(extra.cost[0]):
            problem = "must leave the H of the step positive definite: a cost must be convex"
            raise StepDataError(problem, field="extra.H", value=extra.cost[0].tolist())

    formed: ClassVar[FormedStep | None] = None

    if not TYPE_CHECKING:  # fields as the others, but formed when they are read

        @cached_property
        def contacts(self) -> Contacts:
            """The contact points considered."""
            if self.formed is None:
                raise AttributeError("a step that is not made has no contacts")
            return self.formed.contacts

        @property
        def M_u(self) -> Array:
            """The un-actuated block of the mass matrix, shape (n_u, n_u) [kg, kg m, kg m^2]."""
            return self.hessian.M_u

    @classmethod
    @cache
    def kept(cls) -> tuple[str, ...]:
        """Names of the fields that copies and pickles keep: H's parts in the place of M_u."""
        return *(name for name in super().kept() if name != "M_u"), "hessian"

    def with_fields(self, **changes: Any) -> Self:
        """A copy with some valid fields replaced, without running the checks."""
        if changes.keys() & {"h", "K_q", "M_u"}:
            masses = changes.pop("M_u", self.hessian.masses)
            h, K_q = changes.get("h", self.h), changes.get("K_q", self.K_q)
            changes["hessian"] = Hessian(h, K_q, masses)
        return self.unchecked(**{name: getattr(self, name) for name in self.kept()} | changes)

    def _definite_with(self, of_cost: Array) -> bool:
        """Whether H plus the H of a cost (n_v, n_v) is positive definite, decided exactly.

        It is judged times h over a power of two near h: no entry then leaves float64's range.
        """
        h, twos = math.frexp(self.h)
        part, whole = Fraction(h), Fraction(2) ** -twos
        n_a = self.n_a
        K_q = np.zeros(of_cost.shape)
        M_u = np.zeros(of_cost.shape)
        K_q[:n_a, :n_a] = self.K_q
        M_u[n_a:, n_a:] = self.M_u
        terms = [(part * Fraction(self.h), K_q), (whole, M_u), (part, of_cost)]
        return positive_sum(self.H, terms)

    @property
    def coupled_entries(self) -> tuple[Indices, Indices]:
        """Rows and columns, (k,) each, of the entries of H that are not zero."""
        if self.extra.cost is None:
            return self.hessian.entries
        of_cost = np.nonzero(self.extra.cost[0])
        i, j = (np.concatenate(both) for both in zip(self.hessian.entries, of_cost, strict=True))
        return i, j

    def coupled(self) -> Mask:
        """A mask of the entries of H that are not zero, shape (n_v, n_v)."""
        coupled = np.zeros((self.n_v, self.n_v), dtype=bool)
        coupled[self.coupled_entries] = True
        return coupled

    @property
    def n_a(self) -> int:
        """Number of actuated coordinates."""
        return int(self.tau_a.size)

    @property
    def n_u(self) -> int:
        """Number of un-actuated coordinates."""
        return int(self.tau_u.size)

    @property
    def n_v(self) -> int:
        """Number of coordinates of delta_q."""
        return self.n_a + self.n_u

    @property
    def m(self) -> int:
        """Number of all multipliers, the user's own rows last; in a polyhedral cone, of rows."""
        return int(self.offsets[-1]) + len(self.extra.names)

    @cached_property
    def row_layout(self) -> RowLayout:
        """Which rows of the cone the contacts have; one object for steps that have the same."""
        return row_layout(self.cone, self.contacts.rows.tobytes())

    @property
    def counts(self) -> Indices:
        """Number of multipliers of each contact, shape (n_c,); in a polyhedral cone, of rows."""
        return self.row_layout.counts

    @property
    def mask(self) -> Mask:
        """Which of the cone's rows each contact has, shape (n_c, R)."""
        return self.row_layout.mask

    @property
    def offsets(self) -> Indices:
        """Where each contact's rows start in A, b and lam, shape (n_c + 1,)."""
        return self.row_layout.offsets

    @property
    def deepest(self) -> float:
        """Depth of the deepest penetration; negative if there is none [m]."""
        if self.formed is not None:
            return self.formed.deepest
        return -float(self.contacts.phi.min(initial=math.inf))

    @cached_property
    def H(self) -> Array:
        """H of Eq. :eq:`eq-13` and of a user's cost, shape (n_v, n_v)."""
        H = self.hessian.matrix
        cost = self.extra.cost
        return H if cost is None else read_only(H + cost[0])

    def replace(self, **changes: Any) -> StepData:
        """A copy with some fields changed, validated again."""
        return StepData(**(field_values(self) | changes))


def check_step(step: object, field: str = "step") -> None:
    """Refuse an argument that is no step: InputError."""
    check_kind(step, StepData, field, "a StepData, as run.step_data(0) returns")


def _lengths(values: Mapping[str, ArrayLike]) -> list[int]:
    """Numbers of entries of vectors, of rows of matrices [-]."""
    arrays = [checked_numbers(value, name) for name, value in values.items()]
    return [len(array) if array.ndim else 1 for array in arrays]


KIND: dict[str, Callable[[StepData], ArrayLike]] = {
    "cone": lambda step: step.cone,
    "h": lambda step: step.h,
    "n_a": lambda step: step.n_a,
    "n_u": lambda step: step.n_u,
    "contacts.rows": lambda step: step.contacts.rows,
    "contacts.mu_v": lambda step: step.contacts.mu_v,
    "contacts.mu_omega": lambda step: step.contacts.mu[:, 2],  # 0 where it is not used
    "extra": lambda step: len(step.extra.names),
    "extra.cost": lambda step: step.extra.cost is not None,
}
"""What the steps of one compiled problem may have in common."""


def differences(template: StepData, step: StepData, names: Iterable[str] = KIND) -> list[str]:
    """Those of `names` in which two steps differ."""
    both = {n: (KIND[n](template), KIND[n](step)) for n in names}
    return [n for n, (one, other) in both.items() if not _same(one, other)]


def _same(one: ArrayLike, other: ArrayLike) -> bool:
    return one is other or np.array_equal(one, other)


def seconds(h: object) -> float:
    """A time step h [s], checked; StepDataError unless it is a positive number."""
    value = checked_numbers(h, "h")
    if value.shape != () or not 0 < value < np.inf:
        raise StepDataError("must be a positive number of seconds", field="h", value=h)
    return float(value)
