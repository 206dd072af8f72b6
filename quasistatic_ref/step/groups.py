"""Groups of coordinates that nothing couples: each is a step of its own.

Two coordinates belong together if an entry of H off its diagonal couples them (one of M_u, K_q or
a user's cost), or a contact, or a
row of the user's own, moves with both. H is then block diagonal and A has rows of one group each:
the optimum of the step consists of those of its groups. A group is mostly a body, or some bodies
that touch each other.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from quasistatic_ref.step.data import Indices, Mask, StepData


class Group(NamedTuple):
    """Part of a step, by where it stands in it; each array is ascending.

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
        """Those of some rows of the step that are in the group, counted in it, in their order."""
        place = {row: i for i, row in enumerate(self.rows.tolist())}
        return [place[row] for row in rows if row in place]


def groups(step: StepData, near: Mask | None = None) -> list[Group]:
    """The groups of a step, in the order of their first coordinates.

    Rows in which nothing moves belong to the first group.

    Parameters
    ----------
    step : StepData
    near : ndarray of bool, shape (n_c,), optional
        The contacts that count; the others belong to no group. By default all do.

    Returns
    -------
    list of Group
        At least one.
    """
    near = np.ones(step.contacts.n_c, dtype=bool) if near is None else near
    contact, of_contact = np.nonzero(step.contacts.J.any(axis=1))
    extra_row, of_extra = np.nonzero(step.extra.A)
    pairs = (contact, of_contact, extra_row, of_extra, *step.coupled(), step.counts)
    pattern = [np.asarray(entries, np.int64).tobytes() for entries in pairs]
    return [*_groups(step.n_v, len(step.extra.names), near.tobytes(), *pattern)]


@lru_cache(maxsize=64)
def _groups(n_v: int, n_extra: int, near_contacts: bytes, *pattern: bytes) -> tuple[Group, ...]:
    """The groups of all steps whose numbers differ from zero in the same places.

    Parameters
    ----------
    n_v, n_extra : int
        Numbers of coordinates and of the user's own rows.
    near_contacts : bytes
        Of the mask `near` of :func:`groups`.
    *pattern : bytes
        Of pairs: contact and coordinate, own row and coordinate, both coordinates of an entry of H;
        and of the number of rows of each contact.
    """
    near = np.frombuffer(near_contacts, np.bool_)
    n_c = len(near)
    contact, of_contact, extra_row, of_extra, first, second, counts = (
        np.frombuffer(entries, np.int64) for entries in pattern
    )
    is_near = near[contact]
    contact, of_contact = contact[is_near], of_contact[is_near]
    of_hessian = np.arange(len(first)) + n_c + n_extra
    coupling = np.concatenate([contact, n_c + extra_row, of_hessian, of_hessian])
    coordinate = np.concatenate([of_contact, of_extra, first, second])
    count = n_c + n_extra + len(first)
    label, of_coupling = labels(n_v, count, coupling, coordinate)
    firsts = np.unique(label) if n_v else np.zeros(1, np.int64)
    of_contacts = np.where(near, of_coupling[:n_c], -1)
    of_extra_rows = of_coupling[n_c : n_c + n_extra]
    of_rows = np.concatenate([np.repeat(of_contacts, counts), of_extra_rows])
    members = []
    for entries in (
        label,
        of_contacts,
        of_extra_rows,
        of_rows,
    ):  # which entries have each of the labels `firsts`, ascending
        order = np.argsort(entries, kind="stable")
        order.setflags(write=False)
        members.append(np.split(order, np.searchsorted(entries[order], firsts))[1:])
    return tuple(Group(*parts) for parts in zip(*members, strict=True))


def labels(
    n: int, couplings: int, coupling: Indices, coordinate: Indices
) -> tuple[Indices, Indices]:
    """The first coordinate of the group of each coordinate, (n,), and of each coupling.

    A coupling is a contact, a row of the user's own, or an entry of H off its diagonal. Each pair
    (coupling, coordinate) says that the coupling has this coordinate. Each coordinate takes the
    least label among those that share a coupling with it, until no label changes.
    """
    label = np.arange(n)
    while True:
        least = np.full(couplings, n)
        np.minimum.at(least, coupling, label[coordinate])
        lower = label.copy()
        np.minimum.at(lower, coordinate, least[coupling])
        lower = lower[lower]  # a label is a coordinate of the same group
        if np.array_equal(lower, label):
            return label, np.where(least < n, least, 0)
        label = lower


def group_steps(step: StepData) -> list[tuple[Group, StepData]]:
    """The groups of a step, each with its own step; the step itself if there is one group.

    Parameters
    ----------
    step : StepData
    """
    members = groups(step)
    if len(members) == 1:
        return [(members[0], step)]
    return [(group, _group_step(step, group)) for group in members]


def _group_step(step: StepData, group: Group) -> StepData:
    """The step of one group."""
    a, u = split(step, group)
    return StepData(
        h=step.h,
        K_q=step.K_q[np.ix_(a, a)],
        M_u=step.inertia(u),
        tau_a=step.tau_a[a],
        tau_u=step.tau_u[u],
        delta_q_bar_a=step.delta_q_bar_a[a],
        contacts=step.contacts.some(group.contacts, group.coordinates),
        cone=step.cone,
        extra=step.extra.of(group.extra_rows, group.coordinates),
    )


def split(step: StepData, group: Group) -> tuple[Indices, Indices]:
    """Actuated and un-actuated coordinates of a group, each counted from the first of its kind."""
    c = group.coordinates
    return c[c < step.n_a], c[c >= step.n_a] - step.n_a
