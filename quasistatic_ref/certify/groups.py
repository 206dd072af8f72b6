"""Groups of coordinates that nothing couples: each is a step of its own.

Two coordinates belong together if an entry of H off its diagonal couples them (one of M_u, K_q or
a user's cost), or a contact, or a row of the user's own, moves with both. H is then block diagonal
and A has rows of one group each: the optimum of the step consists of those of its groups. A group
is mostly a body, or some bodies that touch each other.

Rows have a number, or a contact and a row of it. The rows of A are contact-major; the user's own
rows come last, as if of one contact more.
"""

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from quasistatic_ref.exact.components import connected_components
from quasistatic_ref.numbers.arrays import Indices, read_only
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData

Pairs = tuple[Indices, Indices]
"""Numbers of couplings, and of coordinates that they couple, shape (k,) each."""
NOTHING: Pairs = np.zeros(0, np.int64), np.zeros(0, np.int64)


class Group(NamedTuple):
    """Indices of a group's coordinates, contacts and rows within a step, each ascending.

    Parameters
    ----------
    coordinates : ndarray of int, shape (n,)
    contacts : ndarray of int, shape (c,)
    extra_rows : ndarray of int, shape (e,)
        Rows of the user's own.
    rows : ndarray of int, shape (m,)
        Rows of A: those of its contacts, then its own.
    """

    coordinates: Indices
    contacts: Indices
    extra_rows: Indices
    rows: Indices

    def within(self, rows: Sequence[int]) -> list[int]:
        """The given rows of the step that belong to this group, renumbered within the group."""
        place = {row: i for i, row in enumerate(self.rows.tolist())}
        return [place[row] for row in rows if row in place]


class Groups(tuple[Group, ...]):
    """The groups of all steps of one structure: one object, equal to itself alone."""

    __slots__ = ()
    __eq__ = object.__eq__
    __hash__ = object.__hash__


def groups(step: StepData) -> Groups:
    """The groups of a step, in the order of their first coordinates; at least one.

    Rows in which nothing moves belong to the first group.

    Parameters
    ----------
    step : StepData
    """
    extra = step.extra
    row, of_row = np.nonzero(extra.A)
    of_step = step.contacts.couplings, step.coupled_entries, step.counts, step.n_v
    return coupled_groups(*of_step, (row, of_row), len(extra.names))


def coupled_groups(
    of_contacts: Pairs,
    of_H: Pairs,
    counts: Indices,
    n_v: int,
    of_extra: Pairs = NOTHING,
    e: int = 0,
) -> Groups:
    """The groups of steps of one structure, from what may couple coordinates.

    Parameters
    ----------
    of_contacts, of_extra : (ndarray, ndarray) of int, shapes (k,)
        Numbers of contacts, or of e rows of a user's, and of the coordinates that may move them.
    of_H : (ndarray, ndarray) of int, shapes (k,)
        Rows and columns of the entries of H that may be nonzero.
    counts : ndarray of int, shape (n_c,)
        Number of rows of each contact.
    n_v, e : int
    """
    n_c = len(counts)
    n_rows = n_c + e
    coupling = np.concatenate([of_contacts[0], n_c + of_extra[0], n_rows + of_H[0]])
    coordinate = np.concatenate([of_contacts[1], of_extra[1], of_H[1]])
    shape = n_rows + n_v, n_v
    return _groups(coupling.tobytes(), coordinate.tobytes(), shape, counts.tobytes())


@lru_cache(maxsize=64)
def _groups(
    coupling: bytes, coordinate: bytes, shape: tuple[int, int], row_counts: bytes
) -> Groups:
    """The groups of a step, from the pattern of its nonzero numbers.

    Parameters
    ----------
    coupling, coordinate : bytes
        Which coordinates move a contact, or a user's row, or have an entry in a row of H: pairs of
        numbers.
    shape : (int, int)
    row_counts : bytes
        Of the number of rows of each contact.
    """
    every = (np.frombuffer(numbers, np.int64) for numbers in (coupling, coordinate, row_counts))
    of_coupling, of_coordinate, counts = every
    return Groups(groups_of(of_coupling, of_coordinate, shape, counts))


def groups_of(
    coupling: Indices, coordinate: Indices, shape: tuple[int, int], counts: Indices
) -> tuple[Group, ...]:
    """The groups of coordinates that couplings make.

    Parameters
    ----------
    coupling, coordinate : ndarray of int, shape (k,)
        Each coordinate of each coupling: of contacts, of a user's rows, of rows of H.
    shape : (int, int)
        Number of couplings and of coordinates.
    counts : ndarray of int, shape (n_c,)
        Number of rows of each contact.
    """
    n_v = shape[1]
    label, of_coupling = connected_components(coupling, coordinate, shape)
    of_contacts, of_extra_rows, _ = np.split(of_coupling, [len(counts), shape[0] - n_v])
    of_rows = np.concatenate([np.repeat(of_contacts, counts), of_extra_rows])
    parts = (label, of_contacts, of_extra_rows, of_rows)
    firsts = np.flatnonzero(label == np.arange(n_v)) if n_v else np.zeros(1, np.int64)
    return tuple(
        Group(*(read_only(np.flatnonzero(part == first)) for part in parts)) for first in firsts
    )


def group_steps(step: StepData) -> list[tuple[Group, StepData]]:
    """The groups of a step, each as a step.

    Parameters
    ----------
    step : StepData
    """
    return [(group, group_step(step, group)) for group in groups(step)]


def group_step(step: StepData, group: Group) -> StepData:
    """One group as a step of its own; the step itself if it has a single group."""
    c = group.coordinates
    if len(c) == step.n_v and len(group.rows) == step.m:
        return step
    a = c[c < step.n_a]
    u = c[c >= step.n_a] - step.n_a
    hessian = step.hessian.part(c)
    return StepData.unchecked(
        h=step.h,
        K_q=hessian.K_q,
        hessian=hessian,
        tau_a=read_only(step.tau_a[a]),
        tau_u=read_only(step.tau_u[u]),
        delta_q_bar_a=read_only(step.delta_q_bar_a[a]),
        contacts=step.contacts.some(group.contacts, c),
        cone=step.cone,
        extra=step.extra.of(group.extra_rows, c),
    )


def contact_rows(step: StepData, rows: Iterable[int]) -> tuple[tuple[int, int], ...]:
    """(contact, row) of some rows of A; contact n_c stands for the user's own rows."""
    every = np.array([*rows], dtype=np.int64)
    contact = np.searchsorted(step.offsets[1:], every, side="right")
    row = every - step.offsets[contact]
    return tuple(zip(contact.tolist(), row.tolist(), strict=True))


def flat_rows(step: StepData, pairs: Iterable[tuple[int, int]]) -> tuple[int, ...]:
    """The rows of A that (contact, row) pairs mean.

    Raises
    ------
    IndexError
        If there is no such contact or row.
    """
    sizes = [*step.counts.tolist(), len(step.extra.names)]
    flat = []
    for contact, row in pairs:
        if not (0 <= contact < len(sizes) and 0 <= row < sizes[contact]):
            raise IndexError(f"the step has no row {row} of contact {contact}")
        flat.append(int(step.offsets[contact]) + row)
    return tuple(flat)


def row_owners(step: StepData, rows: Iterable[int]) -> dict[str, list[str]]:
    """Names of the contacts that own the given rows, each with the names of these rows.

    The user's own rows stand under ``"extra"``.
    """
    owners: dict[str, list[str]] = {}
    row_names = cone(step.cone).row_names
    for contact, row in contact_rows(step, rows):
        if contact < step.contacts.n_c:
            owners.setdefault(step.contacts.name[contact], []).append(row_names[row])
        else:
            owners.setdefault("extra", []).append(step.extra.names[row])
    return owners
