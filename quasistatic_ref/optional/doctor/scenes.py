"""A step's targets and loads at some q, in parts: the groups of what touches, alike ones at once.

J is formed by the columns that each contact has, and M_u by its blocks: of 1000 bodies all of both
would have a hundred million entries.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.certify.groups import linked
from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.optional.doctor.slow import SLOWLY, STRAIGHT, Alike, Slow
from quasistatic_ref.parts.solve import posed
from quasistatic_ref.step.data import no_rows

if TYPE_CHECKING:
    from quasistatic_ref.contact.distance import ClosestPoints
    from quasistatic_ref.model.system import SystemState
    from quasistatic_ref.numbers.arrays import Array, Indices, Mask
    from quasistatic_ref.optional.doctor.run import Run
    from quasistatic_ref.step.data import Extra, StepData


class Sparse(NamedTuple):
    """A step by the columns that each contact has.

    Parameters
    ----------
    n_v : int
    frames : ndarray, shape (n_c, 4, w)
        Of J, along d1, d2 and n, and about n [m, rad].
    column : ndarray of int, shape (n_c, w)
        The coordinates of these columns; n_v where a contact has fewer.
    K_q : ndarray, shape (n_a, n_a)
    M_u : ndarray, shape (k, n_u / k, n_u / k)
        Diagonal blocks.
    load : ndarray, shape (n_v,)
        tau_k + tau_a and tau_u [N, N m].
    extra : Extra
    """

    n_v: int
    frames: Array
    column: Indices
    K_q: Array
    M_u: Array
    load: Array
    extra: Extra

    @property
    def n_a(self) -> int:
        """Number of actuated coordinates."""
        return len(self.K_q)

    def masses(self, u: Indices) -> Array:
        """M_u of some coordinates, (..., k), counted from the first, shape (..., k, k)."""
        block, i = np.divmod(u, self.M_u.shape[-1])
        same = block[..., :, None] == block[..., None, :]
        entries = self.M_u[block[..., :, None], i[..., :, None], i[..., None, :]]
        return np.where(same, entries, 0.0)

    def couplings(
        self, near: Indices, rows: Indices, body: Indices
    ) -> tuple[Indices, Indices, tuple[int, int]]:
        """Which coordinates some contacts, rows, bodies and entries of H couple, as of ``linked``.

        Of a body that no contact is near, others may couple none.
        """
        moves = self.frames[near].any(axis=1)
        contact, k = np.nonzero(moves)
        row, of_row = np.nonzero(self.extra.A[rows])
        K, of_K = np.nonzero(self.K_q)
        block, i, j = np.nonzero(self.M_u)
        first = self.n_a + self.M_u.shape[-1] * block
        cost = self.extra.cost
        H, of_H = np.nonzero(np.zeros((0, 0)) if cost is None else cost[0])
        v = np.arange(self.n_v)
        of_H = np.concatenate([of_K, first + j, of_H])
        each = [contact, row, np.concatenate([K, first + i, H]), body]
        firsts = np.cumsum([0, len(near), len(rows), self.n_v])
        coupling = np.concatenate([x + first for x, first in zip(each, firsts, strict=True)])
        coordinate = np.concatenate([self.column[near][contact, k], of_row, of_H, v])
        return coupling, coordinate, (firsts[-1] + body.max(initial=0) + 1, self.n_v)


def by_columns(run: Run, k: int, here: SystemState, points: ClosestPoints) -> Sparse:
    """A step of a run without an extension, at a state of its own."""
    axes = np.stack([*tangents(points.n), points.n], axis=1)
    x, of_alpha, of_beta = run.own_columns
    columns = np.pad(here.kinematics.columns, [(0, 0), (0, 1)])[:, x]
    nu, omega = np.moveaxis(columns.reshape(2, 3, *x.shape), 1, -1)
    motion = of_beta * (nu + np.cross(omega, points.beta[:, None]))
    motion = motion - of_alpha * (nu + np.cross(omega, points.alpha[:, None]))
    spin = (of_beta - of_alpha) * omega
    along = axes @ motion.swapaxes(1, 2)
    about = points.n[:, None] @ spin.swapaxes(1, 2)
    system = run.system
    n_v = system.n_v
    K_q = run.simulator.K_q
    load = run.noted("tau")[k].copy()
    load[: system.n_a] += K_q @ here.change_to(run["q_bar_a"][k])
    M_u = system.mass_blocks if system.constant_mass_matrix else here.M_u[None]
    column = np.append(system.column_map.owner, n_v)[x]
    frames = np.concatenate([along, about], axis=1)
    return Sparse(n_v, frames, column, K_q, M_u, load, no_rows(n_v))


def of_step(step: StepData) -> Sparse:
    """A step whose J has all its columns."""
    contacts = step.contacts
    axes = np.stack([contacts.d1, contacts.d2, contacts.n], axis=1)
    frames = np.concatenate([axes @ contacts.J[:, :3], contacts.J[:, 3:]], axis=1)
    column = np.tile(np.arange(step.n_v), (contacts.n_c, 1))
    load = np.concatenate([step.K_q @ step.delta_q_bar_a + step.tau_a, step.tau_u])
    return Sparse(step.n_v, frames, column, step.K_q, step.M_u[None], load, step.extra)


class Scene:
    """A step's targets and loads at some q, with the contacts that a straight step may reach.

    Parameters
    ----------
    run : Run
    k : int
        Of the step.
    q : ndarray, shape (n_q,)
    gap : ndarray, shape (n_c,)
        Of the contacts of step k [m]: what is not above one that touches counts as near.
    points : ClosestPoints, optional
        At q, where they are known.
    cone : str, optional
        In the place of the run's.
    contacts : ndarray of bool, shape (n_c,), optional
        Those that may bear; by default all.

    Attributes
    ----------
    step : Sparse
    phi : ndarray, shape (n_c,)
        Of all contacts [m].
    parts : list of Slow
        The groups of the scene: all that are alike at once.
    """

    def __init__(
        self,
        run: Run,
        k: int,
        q: Array,
        gap: Array,
        points: ClosestPoints | None = None,
        cone: str | None = None,
        contacts: Mask | bool = True,
    ) -> None:
        simulator = run.simulator
        here = run.system.at(q)
        points = points or simulator.closest_points(here.kinematics)
        if simulator.extension is None:
            self.step = by_columns(run, k, here, points)
        else:
            step = simulator.step_at(here, run["q_bar_a"][k], run.noted("tau")[k], points)
            self.step = of_step(posed(step, simulator.extension(q))[0])
        self.phi = points.phi
        highest = np.zeros(len(run.pairs))
        np.maximum.at(highest, run.pair_of, np.where(run.touches[k], 1.01 * gap, 0.0))
        reach = np.maximum(STRAIGHT * run.sizes, highest[run.pair_of])
        near = np.flatnonzero(contacts & (self.phi <= reach))
        lengths = np.ones(self.step.n_v, dtype=bool)  # so are private rises
        lengths[: run.system.n_v] = run.lengths
        extra = self.step.extra
        slides = (extra.A[:, lengths] != 0).any(axis=1)
        stops = np.where(slides, STRAIGHT * run.sizes.min(initial=1.0), STRAIGHT)
        rows = np.flatnonzero(-extra.b <= stops)
        end = max(SLOWLY, 1000 * run.h)
        bodies = [(body.mass, body.size, run.loads[body][k]) for body in run.bodies_of]
        of_bodies = np.array([*bodies, (0.0, 0.0, np.inf)]).T
        self.parts = [
            Slow(groups, cone or simulator.cone, end, of_bodies)
            for groups in self._alike(run, near, rows, ~lengths)
        ]

    def _alike(self, run: Run, near: Indices, rows: Indices, angles: Mask) -> Iterator[Alike]:
        """The groups of some contacts and rows: of each kind all."""
        step = self.step
        extra = step.extra
        cost = extra.cost
        n_a = step.n_a
        nobody = len(run.bodies_of)
        bodies = np.append(run.body_of, np.full(step.n_v - len(run.body_of), nobody))
        v = np.arange(step.n_v)
        alone = np.where(bodies < nobody, bodies, nobody + v)
        label, of_coupling = linked(*step.couplings(near, rows, alone))
        firsts, group = np.unique(label, return_inverse=True)
        of_contact, of_row, _ = np.split(
            np.searchsorted(firsts, of_coupling), [len(near), len(near) + len(rows)]
        )
        members = [
            _members(of, len(firsts)) for of in (group[:n_a], group[n_a:], of_contact, of_row)
        ]
        kinds, kind = np.unique([count for count, _, _ in members], axis=1, return_inverse=True)
        for i, sizes in enumerate(kinds.T.tolist()):
            of = np.flatnonzero(kind.ravel() == i)
            a, u, c, e = (
                order[starts[of][:, None] + np.arange(size)]
                for (_, starts, order), size in zip(members, sizes, strict=True)
            )
            v = np.hstack([a, n_a + u])
            n = sizes[0] + sizes[1]
            within = np.full(step.n_v + 1, n)
            within[v] = np.arange(n)
            contacts = near[c]
            yield Alike(
                coordinates=v,
                contacts=contacts,
                bodies=bodies[n_a + u],
                K_q=step.K_q[a[:, :, None], a[:, None]],
                M_u=step.masses(u),
                load=step.load[v],
                phi=self.phi[contacts],
                sizes=run.sizes[contacts],
                frames=self._frames(contacts, within, n),
                mu=run.mu[contacts],
                turns=angles[v] & (v >= n_a),
                A=extra.A[rows[e][:, :, None], v[:, None]],
                b=extra.b[rows[e]],
                H=np.zeros((len(v), n, n)) if cost is None else cost[0][v[:, :, None], v[:, None]],
                g=np.zeros(v.shape) if cost is None else cost[1][v],
            )

    def _frames(self, contacts: Indices, within: Indices, n: int) -> Array:
        """J of the contacts of groups, (B, c), along their axes: (B, c, 4, n)."""
        of = contacts.ravel()
        frames = np.zeros((len(of), n + 1, 4))
        place = within[self.step.column[of]]
        columns = self.step.frames[of].swapaxes(1, 2)
        np.add.at(frames, (np.arange(len(of))[:, None], place), columns)  # a mimic's is one more
        return frames[:, :n].swapaxes(1, 2).reshape(*contacts.shape, 4, n)

    def gaps(self, way: Array) -> Array:
        """Gaps of all contacts after a motion, to first order, shape (n_c,) [m].

        Parameters
        ----------
        way : ndarray, shape (n_v,)
            [m, rad]
        """
        moved = np.append(way, 0.0)[self.step.column]
        return np.asarray(self.phi + np.vecdot(self.step.frames[:, 2], moved))


def _members(group: Indices, groups: int) -> tuple[Indices, Indices, Indices]:
    """Each group's number of members and start in the last array, which has the members in turn."""
    counts = np.bincount(group, minlength=groups)
    return counts, np.cumsum(counts) - counts, np.argsort(group, kind="stable")
