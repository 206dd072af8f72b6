"""The contact points of one step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.shown import Shown
from quasistatic_ref.numbers.arrays import (
    Array,
    Indices,
    Mask,
    check_and_freeze,
    checked_names,
    checked_numbers,
    column_count,
    read_only,
)
from quasistatic_ref.numbers.ordered import product
from quasistatic_ref.step.cones import has_torsion
from quasistatic_ref.tolerances import ORTHONORMAL

IDENTITY = np.eye(3)
ROWS = {4, 6}


@dataclass(frozen=True, eq=False, repr=False)
class Contacts(Plain, Shown):
    """The contact points of one step.

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

    if TYPE_CHECKING:  # what is made of lists, too

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
        ) -> None: ...

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", checked_names(self.name, "contacts.name"))
        n_c = len(self.name)
        scalars = dict.fromkeys(("phi", "mu_v", "mu_omega"), (n_c,))
        vectors = dict.fromkeys(("n", "d1", "d2"), (n_c, 3))
        check_and_freeze(self, {**scalars, **vectors}, "contacts.")
        self._check_rows(n_c)
        self._check_friction()
        self._check_frames(n_c)
        n_v = column_count(self.J, "contacts.J", 3)
        check_and_freeze(self, {"J": (n_c, 4, n_v)}, "contacts.")

    @cached_property
    def n_v(self) -> int:
        """Number of columns of J."""
        return int(self.J.shape[-1])

    @property
    def moved(self) -> tuple[Indices, Indices]:
        """Indices of the contacts and coordinates, (k,) each, for which J is not zero."""
        contact, coordinate = np.nonzero(self.J.any(axis=1))
        return contact, coordinate

    def raised(self, s: Array) -> Contacts:
        """These contacts with gaps phi + s, where s has shape (n_c,) [m]."""
        return replace(self, phi=self.phi + s)

    def motion(self, delta_q: Array) -> Array:
        """J delta_q of each contact, shape (n_c, 4) [m, m, m, rad]."""
        return product(self.J, delta_q) + 0.0  # in one order, whatever columns of J are kept

    def some(self, contacts: Indices, coordinates: Indices) -> Contacts:
        """Some of the contacts, (k,), with the columns of some coordinates, (n,), of J."""
        J = read_only(self.columns(contacts, coordinates))
        return Contacts.unchecked(**self.without_J(contacts), J=J)

    def without_J(self, contacts: Indices) -> dict[str, Any]:
        """The other fields of some of the contacts, (k,), by their names."""
        keys = ("phi", "n", "d1", "d2", "mu_v", "mu_omega", "rows")
        fields = {key: read_only(getattr(self, key)[contacts]) for key in keys}
        return {"name": tuple(self.name[j] for j in contacts.tolist()), **fields}

    def columns(self, contacts: Indices, coordinates: Indices) -> Array:
        """J of some contacts, (k,), and some coordinates, (n,): shape (k, 4, n)."""
        return self.J[contacts[:, None, None], np.arange(4)[:, None], coordinates]

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


def friction_coefficients(mu_v: Array, mu_omega: Array, rows: Indices) -> Array:
    """(mu_v, mu_v, mu_omega), shape (n_c, 3) [-, -, m], of fields of contacts, each (n_c,)."""
    mu = np.array([mu_v, mu_v, mu_omega * has_torsion(rows)])
    return read_only(np.ascontiguousarray(mu.T))
