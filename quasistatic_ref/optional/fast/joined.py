"""Steps of many bodies, kept by contact and by body; whole arrays are formed when they are read."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from quasistatic_ref.formats.plain import Late
from quasistatic_ref.model.mass import entries_of, whole
from quasistatic_ref.numbers.arrays import Array, Indices, read_only
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import StepData, hessian


class JoinedContacts(Late, Contacts):
    """Contacts whose J is formed when it is read.

    Attributes
    ----------
    own_J : ndarray, shape (n_c, 4, w)
        The columns of J that can differ from zero [m, rad].
    column : ndarray of int, shape (n_c, w)
        Which these are, ascending; n_v where a contact has fewer.
    """

    formed = ("J",)
    kept_instead = ("own_J", "column", "n_v")
    own_J: Array
    column: Indices

    @cached_property
    def J(self) -> Array:
        """J of Eq. :eq:`eq-3`, shape (n_c, 4, n_v)."""
        return read_only(spread(self.own_J, self.column, self.n_v))

    @property
    def moved(self) -> tuple[Indices, Indices]:
        """Indices of the contacts and coordinates, (k,) each, for which J is not zero."""
        contact, k = np.nonzero(self.own_J.any(axis=1))
        return contact, self.column[contact, k]

    @property
    def moved_by_all(self) -> bool:
        """Whether each coordinate that can move a contact does."""
        return bool((self.own_J.any(axis=1) | (self.column == self.n_v)).all())

    def motion(self, delta_q: Array) -> Array:
        """J delta_q of each contact, shape (n_c, 4) [m, m, m, rad]."""
        moved = np.concatenate([delta_q, [0.0]])[self.column]
        return np.asarray(np.add.accumulate(self.own_J * moved[:, None], axis=-1)[..., -1]) + 0.0

    def some(self, contacts: Indices, coordinates: Indices) -> Contacts:
        """Some of the contacts, (k,), with the columns of some coordinates, (n,), of J."""
        if len(coordinates) < self.n_v:
            return super().some(contacts, coordinates)
        own = {"own_J": self.own_J[contacts], "column": self.column[contacts], "n_v": self.n_v}
        return type(self).unchecked(**self.without_J(contacts), **own)

    def columns(self, contacts: Indices, coordinates: Indices) -> Array:
        """J of some contacts, (k,), and some coordinates, (n,): shape (k, 4, n)."""
        place = np.full(self.n_v + 1, len(coordinates))
        place[coordinates] = np.arange(len(coordinates))
        return spread(self.own_J[contacts], place[self.column[contacts]], len(coordinates))


class Masses:
    """M_u and H of a simulator's steps, of which M_u may be kept by its blocks.

    Parameters
    ----------
    h : float
        [s]
    K_q : ndarray, shape (n_a, n_a)
        [N/m, N m/rad]
    blocks : ndarray, shape (k, n_u / k, n_u / k), or (n_u, n_u)
        Diagonal blocks of M_u, or all of it [kg, kg m, kg m^2].
    """

    def __init__(self, h: float, K_q: Array, blocks: Array) -> None:
        self.h = h
        self.K_q = K_q
        self.blocks = blocks

    @property
    def constant(self) -> bool:
        """Whether M_u is kept by its blocks, which are the same in all steps."""
        return self.blocks.ndim == 3

    @cached_property
    def M_u(self) -> Array:
        """The un-actuated block of the mass matrix, shape (n_u, n_u) [kg, kg m, kg m^2]."""
        return whole(self.blocks)

    @cached_property
    def H(self) -> Array:
        """H of Eq. :eq:`eq-13`, shape (n_v, n_v)."""
        return hessian(self.h, self.K_q, self.M_u)

    def some(self, u: Indices) -> Array:
        """M_u of some un-actuated coordinates, counted from the first, shape (k, k)."""
        return entries_of(self.blocks, u)

    @cached_property
    def entries(self) -> tuple[Indices, Indices]:
        """Rows and columns, (k,) each, of the entries of H where K_q or M_u is nonzero."""
        first = len(self.K_q)
        *block, i, j = np.nonzero(self.blocks)
        if block:
            first = first + self.blocks.shape[-1] * block[0]
        of_K, of_K_column = np.nonzero(self.K_q)
        return np.concatenate([of_K, first + i]), np.concatenate([of_K_column, first + j])

    def of(self, coordinates: Indices) -> Array:
        """H of some coordinates, shape (k, k)."""
        n_a = len(self.K_q)
        a = coordinates[coordinates < n_a]
        u = coordinates[coordinates >= n_a] - n_a
        return hessian(self.h, self.K_q[np.ix_(a, a)], self.some(u))


class JoinedStep(Late, StepData):
    """A step whose M_u and H are formed when they are read.

    Attributes
    ----------
    of_masses : Masses
    """

    formed = ("M_u",)
    kept_instead = ("of_masses",)
    contacts: JoinedContacts
    of_masses: Masses

    def with_fields(self, **changes: Any) -> Any:
        """A copy with some valid fields replaced: as late, unless H is another then."""
        if changes.keys() & {"h", "K_q", "M_u", "extra"}:
            return super().with_fields(**changes)
        return type(self).unchecked(**{name: getattr(self, name) for name in self.kept()} | changes)

    @cached_property
    def M_u(self) -> Array:
        """The un-actuated block of the mass matrix, shape (n_u, n_u) [kg, kg m, kg m^2]."""
        return self.of_masses.M_u

    @cached_property
    def H(self) -> Array:
        """H of Eq. :eq:`eq-13`, shape (n_v, n_v)."""
        return self.of_masses.H

    @property
    def coupled_entries(self) -> tuple[Indices, Indices]:
        """Row and column of each entry that a term of H may have, (k,): no cost has a part."""
        return self.of_masses.entries

    @property
    def couples_all(self) -> bool:
        """Whether the groups of the step are known to be those of all steps of its simulator."""
        return self.of_masses.constant and self.contacts.moved_by_all

    def masses(self, some: Indices) -> Array:
        """M_u of some un-actuated coordinates, (k,), counted from the first: shape (k, k)."""
        return self.of_masses.some(some)


def spread(J: Array, column: Indices, n: int) -> Array:
    """A few columns of each contact's J among n columns, zero elsewhere, shape (k, rows, n).

    Parameters
    ----------
    J : ndarray, shape (k, rows, w)
        [m, rad].
    column : ndarray of int, shape (k, w)
        Which columns these are; n stands for none.
    n : int
    """
    every = np.zeros((len(J), n + 1, J.shape[1]))
    every[np.arange(len(J))[:, None], column] = J.transpose(0, 2, 1)
    return every[:, :n].transpose(0, 2, 1).copy()
