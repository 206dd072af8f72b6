"""The contact points of one step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.numbers.arrays import (
    Array,
    Indices,
    Mask,
    all_finite,
    check_and_freeze,
    checked_array,
    checked_names,
    checked_numbers,
    column_count,
    read_only,
)
from quasistatic_ref.shown import Shown
from quasistatic_ref.step.cones import has_torsion
from quasistatic_ref.text.plain import Plain
from quasistatic_ref.tolerances import ORTHONORMAL

IDENTITY = np.eye(3)
ROWS = {4, 6}


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Contacts(Plain, Shown):
    """The contact points of one step.

    J is kept by each contact's own columns, since few coordinates move a contact. It is formed when
    it is read.

    Parameters
    ----------
    name : tuple of str, length n_c
        A name for each contact, for messages.
    phi : ndarray, shape (n_c,)
        Signed distance [m], negative in penetration.
    n, d1, d2 : ndarray, shape (n_c, 3)
        Unit normal from alpha's body to beta's, and the tangents, in the world frame: {d1, d2, n}
        is right-handed.
    J : ndarray, shape (n_c, 4, n_v)
        Contact Jacobian, Eq. :eq:`eq-3`: rows 0-2 the displacement of the material point at beta
        relative to the one at alpha, in the world frame [m], row 3 the relative rotation about n
        [rad], each per unit of delta_q.
    mu_v : ndarray, shape (n_c,)
        Tangential friction coefficient [-], >= 0.
    mu_omega : ndarray, shape (n_c,)
        Torsional friction coefficient, a length [m], >= 0.
    rows : ndarray of int, shape (n_c,)
        6, or 4 for a contact whose mu_omega is not used. With the paper's cone this is the number
        of the contact's rows; with another cone it only says whether mu_omega is used.

    Attributes
    ----------
    own : ndarray, shape (n_c, 4, w)
        The columns of J that can differ from zero [m, rad]: of a J that was handed over, all.
    column : ndarray of int, shape (n_c, w)
        Which these are; n_v where a contact has fewer.
    n_v : int
        Number of columns of J.
    pyramid : (ndarray, ndarray), shapes (m, w) and (m,), or None
        A, by own columns, and b of Eq. :eq:`eq-8` in the pyramid, where they are known [m, rad].

    Raises
    ------
    StepDataError
        If a shape, a sign or a frame is wrong, or a number is not finite.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> step.contacts.phi.shape, step.contacts.J.shape
    ((1,), (1, 4, 6))
    """

    name: tuple[str, ...]
    phi: Array
    n: Array
    d1: Array
    d2: Array
    J: Array
    mu_v: Array
    mu_omega: Array
    rows: Indices

    if TYPE_CHECKING:
        own: Array
        column: Indices
        n_v: int
    pyramid: ClassVar[tuple[Array, Array] | None] = None

    def __init__(
        self,
        name: Sequence[str],
        phi: ArrayLike,
        n: ArrayLike,
        d1: ArrayLike,
        d2: ArrayLike,
        J: ArrayLike,
        mu_v: ArrayLike,
        mu_omega: ArrayLike,
        rows: ArrayLike,
    ) -> None:
        names = checked_names(name, "contacts.name")
        n_c = len(names)
        given = {"phi": phi, "n": n, "d1": d1, "d2": d2, "mu_v": mu_v, "mu_omega": mu_omega}
        self.__dict__.update(given, name=names, rows=rows)
        scalars = dict.fromkeys(("phi", "mu_v", "mu_omega"), (n_c,))
        vectors = dict.fromkeys(("n", "d1", "d2"), (n_c, 3))
        check_and_freeze(self, {**scalars, **vectors}, "contacts.")
        self._check_rows(n_c)
        self._check_friction()
        self._check_frames(n_c)
        shape = n_c, 4, column_count(J, "contacts.J", 3)
        self.__dict__.update(all_columns(checked_array(J, "contacts.J", shape)))

    if not TYPE_CHECKING:  # a field as the others, but formed when it is read

        @cached_property
        def J(self) -> Array:
            """J of Eq. :eq:`eq-3`, shape (n_c, 4, n_v) [m, rad]."""
            return read_only(spread(self.own, self.column, self.n_v))

    @classmethod
    @cache
    def kept(cls) -> tuple[str, ...]:
        """Names of the fields that copies and pickles keep: own columns in the place of J."""
        every = (name for name in super().kept() if name != "J")
        return *every, "own", "column", "n_v"

    def with_fields(self, **changes: Any) -> Self:
        """A copy with some valid fields replaced, without running the checks."""
        if "J" in changes:
            changes |= all_columns(changes.pop("J"))
        return self.unchecked(**{name: getattr(self, name) for name in self.kept()} | changes)

    @property
    def couplings(self) -> tuple[Indices, Indices]:
        """Indices of the contacts and coordinates, (k,) each, for which J is not zero."""
        contact, k = np.nonzero(self.own.any(axis=1) & (self.column < self.n_v))
        return contact, self.column[contact, k]

    @property
    def moved_by_all(self) -> bool:
        """Whether each coordinate that can move a contact does."""
        return bool((self.own.any(axis=1) | (self.column == self.n_v)).all())

    def raised(self, s: Array) -> Contacts:
        """These contacts with gaps phi + s, s of shape (n_c,) [m]; StepDataError as above."""
        phi = self.phi + s + 0.0
        if not all_finite(phi):
            return replace(self, phi=phi)  # which is refused
        return self.with_fields(phi=read_only(phi))

    def motion(self, delta_q: Array) -> Array:
        """J delta_q of each contact, shape (n_c, 4) [m, m, m, rad]."""
        moved = np.append(delta_q, 0.0)[self.column][:, None]
        if not moved.size:
            return np.zeros((self.n_c, 4))
        # In one order, whatever columns of J are kept.
        return np.asarray(np.add.accumulate(self.own * moved, axis=-1)[..., -1]) + 0.0

    def some(self, contacts: Indices, coordinates: Indices) -> Contacts:
        """Some of the contacts, (k,), with the columns of some coordinates, (n,), of J."""
        n = len(coordinates)
        column = self.column[contacts]
        if n < self.n_v:
            column = self._places(coordinates)[column]
        keys = ("phi", "n", "d1", "d2", "mu_v", "mu_omega", "rows")
        fields = {key: read_only(getattr(self, key)[contacts]) for key in keys}
        return Contacts.unchecked(
            name=tuple([self.name[j] for j in contacts.tolist()]),
            **fields,
            own=read_only(self.own[contacts]),
            column=read_only(column),
            n_v=n,
        )

    def columns(self, contacts: Indices, coordinates: Indices) -> Array:
        """J of some contacts, (k,), and some coordinates, (n,): shape (k, 4, n)."""
        column = self._places(coordinates)[self.column[contacts]]
        return spread(self.own[contacts], column, len(coordinates))

    def _places(self, coordinates: Indices) -> Indices:
        """Where each coordinate, and none, stands among some, (n,): shape (n_v + 1,)."""
        n = len(coordinates)
        place = np.full(self.n_v + 1, n)
        place[coordinates] = np.arange(n)
        return place

    @cached_property
    def n_c(self) -> int:
        """Number of contacts."""
        return len(self.name)

    @property
    def torsion(self) -> Mask:
        """Whether each contact uses its mu_omega, shape (n_c,)."""
        return has_torsion(self.rows)

    @cached_property
    def mu(self) -> Array:
        """(mu_v, mu_v, mu_omega) of each contact, shape (n_c, 3), 0 where it is not used."""
        return friction_coefficients(self.mu_v, self.mu_omega, self.rows)

    def _check_rows(self, n_c: int) -> None:
        whole = isinstance(self.rows, np.ndarray) and self.rows.dtype == np.int64
        rows = self.rows if whole else checked_numbers(self.rows, "contacts.rows")
        if rows.shape != (n_c,) or not set(rows.tolist()) <= ROWS:
            problem = "must be 4 or 6 for each contact"
            raise StepDataError(problem, field="contacts.rows", value=rows.tolist())
        if rows.flags.writeable or not whole:
            object.__setattr__(self, "rows", read_only(rows.astype(np.int64)))

    def _check_friction(self) -> None:
        for key in ("mu_v", "mu_omega"):
            mu = getattr(self, key)
            if mu.min(initial=0.0) < 0:
                j = int(mu.argmin())
                field = f"contacts[{self.name[j]}].{key}"
                raise StepDataError("must be >= 0", field=field, value=float(mu[j]))

    def _check_frames(self, n_c: int) -> None:
        axes = np.array([self.d1, self.d2, self.n])
        # Not by matmul, which warns where numbers overflow: such axes are refused below.
        defect = np.abs(np.einsum("aci,bci->cab", axes, axes) - IDENTITY)
        right_handed = np.linalg.det(axes.transpose(1, 0, 2)) > 0
        if n_c and not (defect.max() <= ORTHONORMAL and right_handed.all()):
            j = int((~(defect.max(axis=(1, 2)) <= ORTHONORMAL) | ~right_handed).argmax())
            problem = "d1, d2, n must be a right-handed orthonormal frame"
            field = self.name[j]
            value = axes[:, j].tolist()
            raise StepDataError(problem, field=f"contacts[{field}]", value=value)


def stacked(each: Sequence[Contacts]) -> Contacts:
    """The contacts of several steps of a run, one step after another, as if of one step.

    What is formed of each contact by itself has the bits that it has in its step.
    """
    if len({one.own.shape for one in each}) > 1:  # of some steps all columns are kept
        each = [one.with_fields(J=one.J) for one in each]
    arrays = ("phi", "n", "d1", "d2", "mu_v", "mu_omega", "rows", "own", "column")
    fields = {name: np.concatenate([getattr(one, name) for one in each]) for name in arrays}
    return Contacts.unchecked(name=each[0].name * len(each), n_v=each[0].n_v, **fields)


def friction_coefficients(mu_v: Array, mu_omega: Array, rows: Indices) -> Array:
    """(mu_v, mu_v, mu_omega), shape (n_c, 3) [-, -, m], of fields of contacts, each (n_c,)."""
    mu = np.array([mu_v, mu_v, mu_omega * has_torsion(rows)])
    return read_only(np.ascontiguousarray(mu.T))


def all_columns(J: Array) -> dict[str, Any]:
    """What :class:`Contacts` keep of a whole J, shape (n_c, 4, n_v) [m, rad]: all its columns."""
    n_c, _, n_v = J.shape
    every = np.broadcast_to(np.arange(n_v), (n_c, n_v))
    return {"J": J, "own": J, "column": every, "n_v": n_v}


def spread(own: Array, column: Indices, n: int) -> Array:
    """A few columns of each contact among n columns, zero elsewhere, shape (k, rows, n).

    Parameters
    ----------
    own : ndarray, shape (k, rows, w)
        [m, rad].
    column : ndarray of int, shape (k, w)
        Which columns these are; n stands for none.
    n : int
    """
    k, rows, _ = own.shape
    every = np.zeros((k, n + 1, rows))
    every[np.arange(k)[:, None], column] = own.transpose(0, 2, 1)
    return every[:, :n].transpose(0, 2, 1).copy()
