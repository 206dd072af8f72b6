"""One step of the model as data: what every implementation must agree on before solving.

Conventions: coordinates are in the paper's order, q = [q_a; q_u]; positions, normals and
tangents are in the world frame; SI units. The JSON form is version 1 of ``quasistatic-ref/step``.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.step.arrays import (
    columns,
    freeze,
    names,
    numbers,
    positive_definite,
    read_only,
)
from quasistatic_ref.step.cones import PYRAMID, cone
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.show import shown
from quasistatic_ref.step.words import extra_page, step_page

__all__ = ["Array", "Contacts", "Extra", "StepData"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Extra:
    """Polyhedral rows of the user's own, A delta_q >= b.

    Parameters
    ----------
    names : tuple of str, length m
    A : ndarray, shape (m, n_v)
    b : ndarray, shape (m,)
    """

    names: tuple[str, ...]
    A: Array
    b: Array

    __repr__, _repr_html_ = shown(extra_page)

    def __post_init__(self) -> None:
        object.__setattr__(self, "names", names(self.names, "extra.names"))
        n_v = columns(self.A, "extra.A", 2)
        freeze(self, "A", (len(self.names), n_v), "extra")
        freeze(self, "b", (len(self.names),), "extra")


@dataclass(frozen=True, eq=False)
class StepData:
    """Everything that Eq. :eq:`eq-13` needs.

    Parameters
    ----------
    h : float
        Time step [s], > 0.
    K_q : ndarray, shape (n_a, n_a)
        Joint stiffness [N/m, N m/rad], symmetric positive definite.
    M_u : ndarray, shape (n_u, n_u)
        Un-actuated block of the mass matrix [kg, kg m^2], symmetric positive definite.
    tau_a : ndarray, shape (n_a,)
        Generalised force on the actuated coordinates besides the stiffness [N, N m].
    tau_u : ndarray, shape (n_u,)
        Generalised force on the un-actuated coordinates [N, N m].
    delta_q_bar_a : ndarray, shape (n_a,)
        Desired change of the actuated coordinates [m, rad].
    contacts : Contacts
        The contact points considered.
    cone : str
        Friction cone; ``"pyramid"`` is the paper's. See :mod:`~quasistatic_ref.step.cones`.
    extra : Extra
        Further rows; none by default.

    Raises
    ------
    StepDataError
        If a shape is wrong, a number is not finite, or H is not positive definite.
    """

    h: float
    K_q: Array
    M_u: Array
    tau_a: Array
    tau_u: Array
    delta_q_bar_a: Array
    contacts: Contacts
    cone: str = PYRAMID
    extra: Extra = field(default=None)  # type: ignore[assignment]  # filled in __post_init__

    __repr__, _repr_html_ = shown(step_page)

    def __post_init__(self) -> None:
        h = numbers(self.h, "h")
        if h.shape != () or not (np.isfinite(h) and h > 0):
            raise StepDataError("must be a positive number of seconds", field="h", value=self.h)
        object.__setattr__(self, "h", float(h))
        if not isinstance(self.contacts, Contacts):
            raise StepDataError("must be Contacts", field="contacts", value=self.contacts)
        cone(self.cone)  # refuses a name that it does not know
        n_a, n_u = np.size(self.tau_a), np.size(self.tau_u)
        if self.extra is None:
            object.__setattr__(self, "extra", Extra((), np.zeros((0, n_a + n_u)), np.zeros(0)))
        freeze(self, "K_q", (n_a, n_a))
        freeze(self, "M_u", (n_u, n_u))
        freeze(self, "tau_a", (n_a,))
        freeze(self, "tau_u", (n_u,))
        freeze(self, "delta_q_bar_a", (n_a,))
        for key in ("K_q", "M_u"):
            object.__setattr__(self, key, positive_definite(key, getattr(self, key)))
        shape_of_J = (self.contacts.n_c, 4, self.contacts.n_v)
        for key, shape in (("contacts.J", shape_of_J), ("extra.A", self.extra.A.shape)):
            if shape[-1] != self.n_v:
                raise StepDataError(
                    f"must have n_a + n_u = {self.n_v} columns", field=key, value=shape
                )

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

    @cached_property
    def counts(self) -> NDArray[np.int64]:
        """Number of multipliers of each contact, shape (n_c,); in a polyhedral cone, of rows."""
        return read_only(cone(self.cone).counts(self.contacts.rows))

    @cached_property
    def mask(self) -> NDArray[np.bool_]:
        """Which of the cone's rows each contact has, shape (n_c, R)."""
        return read_only(np.arange(len(cone(self.cone).row_names)) < self.counts[:, None])

    @cached_property
    def offsets(self) -> NDArray[np.int64]:
        """Where each contact's rows start in A, b and lam, shape (n_c + 1,)."""
        return read_only(np.concatenate([[0], np.cumsum(self.counts)]))

    @cached_property
    def row_index(self) -> NDArray[np.int64]:
        """Which rows of all the cone's, contact-major, the contacts have, shape (m,)."""
        return read_only(np.flatnonzero(self.mask))

    @cached_property
    def row_contact(self) -> NDArray[np.int64]:
        """The contact that each row belongs to, shape (m,)."""
        return read_only(np.repeat(np.arange(self.contacts.n_c), self.counts))

    @cached_property
    def H(self) -> Array:
        """H of Eq. :eq:`eq-13`, shape (n_v, n_v)."""
        H, n_a = np.zeros((self.n_v, self.n_v)), self.n_a
        H[:n_a, :n_a] = self.h * self.K_q
        H[n_a:, n_a:] = self.M_u / self.h
        return read_only(H)

    def replace(self, **changes: Any) -> StepData:
        """Return a copy with some fields changed, validated anew."""
        return replace(self, **changes)

    def moved(
        self, M_u: Array, tau_a: Array, tau_u: Array, delta_q_bar_a: Array, contacts: Contacts
    ) -> StepData:
        """The same kind of step elsewhere: the rest is kept, and nothing is checked.

        For steps in sequence, whose numbers are as good as those of the step before. M_u must be
        read-only; while it is the same array, H is not formed again.
        """
        other = object.__new__(StepData)
        loads = {"tau_a": tau_a, "tau_u": tau_u, "delta_q_bar_a": delta_q_bar_a}
        other.__dict__.update(self.__dict__, contacts=contacts, M_u=M_u, **loads)
        if M_u is not self.M_u:
            other.__dict__.pop("H", None)
        return other

    def same_as(self, other: StepData) -> bool:
        """Tell whether two steps hold the same numbers, bit for bit."""
        return _same(self, other)


def _same(one: Any, two: Any) -> bool:
    for f in fields(one):
        a, b = getattr(one, f.name), getattr(two, f.name)
        if isinstance(a, Contacts | Extra):
            if not _same(a, b):
                return False
        elif isinstance(a, np.ndarray):
            if a.shape != b.shape or not np.array_equal(a, b):
                return False
        elif a != b:
            return False
    return True
