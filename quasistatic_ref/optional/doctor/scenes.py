"""A step's targets and loads at some q, in parts: groups of what touches, alike ones at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.certify.groups import Group, parted
from quasistatic_ref.numbers.blocks import entries_of
from quasistatic_ref.optional.doctor.programs import Alike
from quasistatic_ref.optional.doctor.slow import SLOWLY, STRAIGHT, Slow
from quasistatic_ref.parts import part

if TYPE_CHECKING:
    from quasistatic_ref.contact.distance import ClosestPoints
    from quasistatic_ref.numbers.arrays import Array, Indices, Mask
    from quasistatic_ref.optional.doctor.run import Run
    from quasistatic_ref.step.extension import Posed


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
    every : Contacts
        All of them.
    step : StepData
        Of the near contacts and stops.
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
        points = points or simulator.closest_points(run.system.kinematics(q))
        step = simulator.step_at(q, run["q_bar_a"][k], run.loads_at(k, q), points)
        if simulator.extension is not None:
            posed: Posed = part("posed")
            step = posed(step, simulator.extension(q))[0]
        self.every = step.contacts
        highest = np.zeros(len(run.pairs))
        np.maximum.at(highest, run.pair_of, np.where(run.touches[k], 1.01 * gap, 0.0))
        reach = np.maximum(STRAIGHT * run.sizes, highest[run.pair_of])
        near = np.flatnonzero(contacts & (points.phi <= reach))
        lengths = np.append(run.lengths, np.ones(step.n_v - run.system.n_v, dtype=bool))
        coordinates = np.arange(step.n_v)
        if not step.extra.empty:
            slides = (step.extra.A[:, lengths] != 0).any(axis=1)
            stops = np.where(slides, STRAIGHT * run.sizes.min(initial=1.0), STRAIGHT)
            extra = step.extra.of(np.flatnonzero(-step.extra.b <= stops), coordinates)
            step = step.with_fields(extra=extra)
        self.step = step.with_fields(contacts=step.contacts.some(near, coordinates))
        kinds: dict[tuple[int, ...], list[Group]] = {}
        for group in self._groups(run):
            n_a = int(np.searchsorted(group.coordinates, step.n_a))
            kinds.setdefault((n_a, *map(len, group[:3])), []).append(group)
        bodies = [(body.mass, body.size, run.loads[body][k]) for body in run.bodies_of]
        of_bodies = np.array([*bodies, (0.0, 0.0, np.inf)]).T
        end = max(SLOWLY, 1000 * run.h)
        self.parts = [
            Slow(self._alike(run, near, ~lengths, n_a, groups), cone or step.cone, end, of_bodies)
            for (n_a, *_), groups in kinds.items()
        ]

    def _groups(self, run: Run) -> Sequence[Group]:
        """The groups of the step: all coordinates of a body are in one."""
        step = self.step
        contact, of_contact = step.contacts.moved
        row, of_row = np.nonzero(step.extra.A)
        i, j = step.coupled_entries
        v = np.flatnonzero(run.body_of < len(run.bodies_of))
        first = np.array([body.coordinates[0] for body in run.bodies_of], np.int64)
        i = np.concatenate([i, first[run.body_of[v]]])
        n_c = step.contacts.n_c
        n_rows = n_c + len(step.extra.names)
        coupling = np.concatenate([contact, n_c + row, n_rows + i])
        coordinate = np.concatenate([of_contact, of_row, j, v])
        no_rows = np.zeros(n_c, dtype=np.int64)
        return parted(coupling, coordinate, (n_rows + step.n_v, step.n_v), no_rows)

    def _alike(
        self, run: Run, near: Indices, angles: Mask, n_a: int, groups: Sequence[Group]
    ) -> Alike:
        """Groups of the same sizes, with n_a actuated coordinates each."""
        step = self.step
        contacts = step.contacts
        v, c, e = (np.array([group[i] for group in groups]) for i in range(3))
        u = v[:, n_a:]
        J = np.array([contacts.columns(group.contacts, group.coordinates) for group in groups])
        axes = np.stack([contacts.d1, contacts.d2, contacts.n], axis=1)[c]
        load = np.concatenate([step.K_q @ step.delta_q_bar_a + step.tau_a, step.tau_u])
        H, g = step.extra.cost or (np.zeros((0, 0)), np.zeros(0))
        n = v.shape[1]
        return Alike(
            coordinates=v,
            contacts=near[c],
            bodies=np.append(run.body_of, np.full(step.n_v - run.system.n_v, len(run.bodies_of)))[
                u
            ],
            K_q=step.K_q[v[:, :n_a, None], v[:, None, :n_a]],
            M_u=np.array([entries_of(step.hessian.masses, of - step.n_a) for of in u]),
            load=load[v],
            phi=contacts.phi[c],
            sizes=run.sizes[near[c]],
            frames=np.concatenate([axes @ J[:, :, :3], J[:, :, 3:]], axis=2),
            mu=contacts.mu[c],
            turns=angles[v] & (v >= step.n_a),
            A=step.extra.A[e[:, :, None], v[:, None]],
            b=step.extra.b[e],
            H=H[v[:, :, None], v[:, None]] if H.size else np.zeros((len(v), n, n)),
            g=g[v] if g.size else np.zeros(v.shape),
        )
