"""Steps of a run, each looked at by four laws: what is missing, and what each artifact changes."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.certify.groups import group_step, groups
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.optional.doctor import slowly
from quasistatic_ref.optional.doctor.bodies import Body, Missing
from quasistatic_ref.step.cones import ELLIPSOID, cone
from quasistatic_ref.step.friction import frame_jacobian

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Array, Indices, Mask
    from quasistatic_ref.optional.doctor.run import Run
    from quasistatic_ref.step.data import StepData

RUN, COULOMB, SLOW, ROUND, MODEL = "run", "coulomb", "slow", "round", "model"
"""The run's own law at h; Coulomb's at h, and slowly; that in the ellipsoid; the run's slowly."""
TOUCHES = 1e-6
"""Gap that is none, over the smaller shape [-]."""
NULL = 1e-9
"""Singular value that is none, over the largest [-]."""


class Law(NamedTuple):
    """What contacts do by one law.

    Parameters
    ----------
    forces, motion : ndarray, shape (n_c, 4)
        Along d1, d2 and n, and about n [N, N m] and [m, rad]; NaN where it was not asked.
    """

    forces: Array
    motion: Array


@dataclass(eq=False)
class Look:
    """A step of a run by each law.

    Parameters
    ----------
    k : int
    step : StepData
        As it is in the run.
    laws : dict of str to Law
    missing : dict of str to dict of str to Missing
        By law, of each body of which something is missing.
    live, asked : ndarray of bool, shape (n_c,)
        Contacts that touch or press, and those of groups that were looked at.
    groups : list of ndarray of int
        The contacts of each of these.
    bodies : set of str
        That were looked at, and of which the answer is not open.
    lost : set of str
        Of which it is.
    """

    k: int
    step: StepData
    laws: dict[str, Law]
    live: Mask
    asked: Mask
    missing: dict[str, dict[str, Missing]] = field(default_factory=lambda: {SLOW: {}, ROUND: {}})
    groups: list[Indices] = field(default_factory=list)
    bodies: set[str] = field(default_factory=set)
    lost: set[str] = field(default_factory=set)

    def knows(self, law: str, contacts: Mask | Indices) -> bool:
        """Whether a law has an answer for some contacts, shape (n_c,)."""
        return law in self.laws and bool(np.isfinite(self.laws[law].forces[contacts]).all())

    @cached_property
    def undetermined(self) -> Array:
        """How far inner loads that nothing but contacts feels change forces, shape (n_c, 4, ...).

        They are z with J'z = 0, of contacts with load in the slow step; what slips keeps its ray
        (n, -mu slip). Along d1, d2 and n, and about n; a column a dimension of a group.
        """
        each = [(at, self._inner(at)) for at in self.groups if self.knows(SLOW, at)]
        most = max((z.shape[2] for _, z in each), default=0)
        inner = np.zeros((len(self.live), 4, most))
        for at, z in each:
            inner[at, :, : z.shape[2]] = z
        return inner

    def _inner(self, at: Indices) -> Array:
        """Of one group, shape (len(at), 4, dimensions)."""
        forces = self.laws[SLOW].forces[at]
        loaded = np.flatnonzero(forces[:, 2] > NULL * forces[:, 2].max(initial=0.0))
        if not loaded.size:
            return np.zeros((len(at), 4, 0))
        contacts = self.step.contacts
        J_n, J_1, J_2, J_w = frame_jacobian(contacts, contacts.J)
        frames = np.stack([J_1, J_2, J_n, J_w], axis=1)[at]  # as forces are
        moves = frames.any(axis=(0, 1))
        mu = contacts.mu[at]
        columns = []
        for j in loaded.tolist():
            if mu[j].any() and self._slips(at[j]):
                columns.append((j, forces[j] / forces[j, 2]))
            else:
                rubs = [0, 1] if mu[j, 0] > 0 else []
                rubs = [*rubs, 2, *([3] if mu[j, 2] > 0 else [])]
                columns += [(j, np.eye(4)[i]) for i in rubs]
        z = np.array([column for _, column in columns])
        of = np.array([j for j, _ in columns])
        rows = np.einsum("ki,kiv->kv", z, frames[of][..., moves])
        rows = rows / np.maximum(np.abs(rows).max(axis=0), 1e-300)
        _, sizes, vt = np.linalg.svd(rows.T)
        null = vt[int((sizes > NULL * sizes[0]).sum()) :].T
        inner = np.zeros((len(at), 4, null.shape[1]))
        np.add.at(inner, of, z[:, :, None] * null[:, None, :])
        return inner

    def _slips(self, j: int) -> bool:
        """Whether contact j slips or spins in the slow step."""
        contacts = self.step.contacts
        motion = self.laws[SLOW].motion[j]
        slip = np.hypot(motion[:3] @ contacts.d1[j], motion[:3] @ contacts.d2[j])
        return bool(slip > 1e-9 or (contacts.mu[j, 2] > 0 and abs(motion[3]) > 1e-9))


class Looking:
    """Looks at steps of a run.

    Parameters
    ----------
    run : Run
    """

    def __init__(self, run: Run) -> None:
        self.run = run
        self.solvers = slowly.Solvers()
        self.looks: dict[int, Look] = {}

    def at(self, k: int, names: set[str], corners: bool = False) -> Look:
        """A look at step k, of the groups of some bodies and pairs.

        Parameters
        ----------
        k : int
        names : set of str
        corners : bool
            Whether the round cone is asked.
        """
        run = self.run
        step = run.posed(k)
        if k not in self.looks:
            live = (run["phi"][k] <= TOUCHES * run.sizes) | run.presses[k]
            of_run = Law(np.asarray(run["wrench"][k]), run.noted("moved")[k])
            self.looks[k] = Look(k, step, {RUN: of_run}, live, np.zeros_like(live))
        look = self.looks[k]
        self._solve(look, step, names, corners)
        return look

    def alone(self, k: int, body: Body, contacts: Mask) -> Look:
        """Step k as if a body had some of its contacts alone."""
        step = self.run.posed(k)
        live = contacts & self.run.presses[k]
        look = Look(k, step, {}, live, np.zeros_like(live))
        self._solve(look, step, {body.name}, False)
        return look

    def _solve(self, look: Look, whole: StepData, names: set[str], corners: bool) -> None:
        run = self.run
        live = np.flatnonzero(look.live)
        every = np.arange(whole.n_v)
        delta_q = run.delta_q_of(look.k, whole.n_v)
        extra = whole.extra
        reach = np.abs(extra.A) @ np.abs(delta_q)
        near = np.flatnonzero(-extra.b <= reach + 1e-12)
        kept = whole.replace(contacts=whole.contacts.some(live, every), extra=extra.of(near, every))
        for group in groups(kept):
            at = live[group.contacts]
            moved = set(group.coordinates.tolist())
            bodies = [b for b in run.bodies_of if not moved.isdisjoint(b.coordinates.tolist())]
            pairs = {run.pairs[i].name for i in run.pair_of[at]}
            asked = look.asked[at].any() or {b.name for b in bodies} & (look.bodies | look.lost)
            if asked or not names & ({b.name for b in bodies} | pairs):
                continue
            look.asked[at] = True
            look.groups.append(at)
            part = group_step(kept, group)
            try:
                of_run = delta_q[group.coordinates]
                part = slowly.landed(part, run.presses[look.k, at], of_run)
                self._group(look, part, group.coordinates, at, bodies, corners)
            except QuasistaticError:  # a step that has no solution, or no float64
                look.lost |= {b.name for b in bodies}

    def _group(
        self,
        look: Look,
        part: StepData,
        coordinates: Indices,
        at: Indices,
        bodies: list[Body],
        corners: bool,
    ) -> None:
        run = self.run
        sizes = run.sizes[at]
        nothing = np.zeros(len(at))
        first = slowly.rung(part, part.h, self.solvers, sizes, nothing)
        climbed = slowly.climb(part, self.solvers, sizes, first)
        if climbed.open:
            look.lost |= {b.name for b in bodies}
            return
        look.bodies |= {b.name for b in bodies}
        last = climbed.rungs[-1]
        self._missing(look, SLOW, part, climbed, coordinates, at, bodies)
        if last.answer.creeps or (first is not None and first.answer.creeps):
            return
        self._note(look, SLOW, part, last.answer, at)
        if first is not None:
            self._note(look, COULOMB, part, first.answer, at)
        layer = first is not None and RUN in look.laws and self._differs(look, at)
        if layer:
            model = self.solvers(part.replace(h=last.T), proved=False)
            self._note(look, MODEL, part, model, at)
        slips = (last.s > slowly.STICKS * sizes).any()
        if cone(part.cone).polyhedral and part.cone != "frictionless" and slips:
            missing = any(b.name in look.missing[SLOW] for b in bodies)
            if corners or missing:
                self._in_round(look, part, coordinates, at, bodies, climbed)

    def _in_round(
        self,
        look: Look,
        part: StepData,
        coordinates: Indices,
        at: Indices,
        bodies: list[Body],
        climbed: slowly.Climb,
    ) -> None:
        try:
            other = part.replace(cone=ELLIPSOID)
            rungs = [
                slowly.rung(other, one.T, self.solvers, self.run.sizes[at], one.s)
                for one in climbed.rungs
            ]
        except QuasistaticError:  # no optional/ellipsoid, or no solution
            return
        found = [one for one in rungs if one is not None]
        if len(found) == len(rungs):
            self._note(look, ROUND, other, found[-1].answer, at)
            of_round = slowly.Climb(found, False)
            self._missing(look, ROUND, other, of_round, coordinates, at, bodies)

    def _differs(self, look: Look, at: Indices) -> bool:
        """Whether Coulomb's law has other forces than the run."""
        run, coulomb = (look.laws[law].forces[at] for law in (RUN, COULOMB))
        most = np.abs(run[:, 2]).max(initial=0.0)
        return bool(np.abs(run - coulomb)[:, 2].max(initial=0.0) > 0.01 * most)

    def _missing(
        self,
        look: Look,
        law: str,
        part: StepData,
        climbed: slowly.Climb,
        coordinates: Indices,
        at: Indices,
        bodies: list[Body],
    ) -> None:
        n_a = int((coordinates < look.step.n_a).sum())
        of_u = coordinates[n_a:]
        for body in bodies:
            here = np.isin(body.coordinates, of_u)
            r = np.zeros(len(here))
            places = np.searchsorted(of_u, body.coordinates[here])
            r[here] = slowly.missing(part, climbed, places)
            lacks = body.missing(r, look.step)
            if body.free and not body.contacts[at].any():
                continue  # it falls freely, which is said elsewhere
            if lacks.amount > slowly.LITTLE * self.run.load(body, look.k):
                look.missing[law][body.name] = lacks

    def _note(
        self, look: Look, law: str, part: StepData, answer: slowly.Answer, at: Indices
    ) -> None:
        if law not in look.laws:
            of_all = np.where(look.live[:, None], np.nan, 0.0)
            look.laws[law] = Law(np.tile(of_all, 4), np.tile(of_all, 4))
        look.laws[law].forces[at] = answer.forces
        look.laws[law].motion[at] = part.contacts.motion(answer.delta_q)
