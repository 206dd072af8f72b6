"""Steps of a run, each looked at by four laws: what is missing, and what each artifact changes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.certify.groups import Group, group_step, groups
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.optional.doctor import slowly
from quasistatic_ref.optional.doctor.bodies import Body, Missing
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.friction import frame_jacobian

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Array, Indices, Mask
    from quasistatic_ref.optional.doctor.run import Run
    from quasistatic_ref.step.contacts import Contacts
    from quasistatic_ref.step.data import StepData

RUN, COULOMB, SLOW, ROUND, MODEL = "run", "coulomb", "slow", "round", "model"
"""The run's own law at h; Coulomb's at h, and slowly; that in the ellipsoid; the run's slowly."""
TOUCHES = 1e-6
"""Gap that is none, over the smaller shape [-]."""
NULL = 1e-9
"""Singular value that is none, over the largest [-]."""
GROUP = 50_000
"""Most entries of J, 4 n_c n_v, of a group that is looked at."""

KEPT = 8
"""Groups whose answers are kept for those that are alike."""


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
    laws : dict of str to Law
    live : ndarray of bool, shape (n_c,)
        Contacts that touch or press.
    missing : dict of str to dict of str to Missing
        By law, of each body of which something is missing.
    inner : dict of int to ndarray, shape (5, dimensions)
        Of each pair, how far inner loads that nothing but contacts feels change its resultants.
    asked : ndarray of bool, shape (n_c,)
        Contacts of groups that were looked at.
    bodies : set of str
        That were looked at, and of which the answer is not open.
    lost, large : set of str
        Of which it is, and which are in a group that is too large.
    """

    k: int
    laws: dict[str, Law]
    live: Mask
    missing: dict[str, dict[str, Missing]] = field(default_factory=lambda: {SLOW: {}, ROUND: {}})
    inner: dict[int, Array] = field(default_factory=dict)
    bodies: set[str] = field(default_factory=set)
    lost: set[str] = field(default_factory=set)
    large: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.asked = np.zeros_like(self.live)

    def knows(self, law: str, contacts: Mask | slice) -> bool:
        """Whether a law has an answer for some contacts, shape (n_c,)."""
        return law in self.laws and bool(np.isfinite(self.laws[law].forces[contacts]).all())


def resultants(axes: tuple[Array, Array], forces: Array) -> Array:
    """Sums of forces, (n_c, 4, ...): the normal one, friction along the axes, and torque, (5, ...).

    The axes are d1 and d2, each (n_c, 3) [-]. Units are those of the forces [N, N, N, N, N m].
    """
    f_1, f_2, f_n, torque = np.moveaxis(forces, 1, 0)
    rubs = axes[0].T @ f_1 + axes[1].T @ f_2
    return np.concatenate([[f_n.sum(axis=0)], rubs, [torque.sum(axis=0)]])


def inner_loads(contacts: Contacts, forces: Array, motion: Array) -> Array:
    """Forces z with J'z = 0, of contacts with load; what slips keeps its ray (n, -mu slip).

    Parameters
    ----------
    contacts : Contacts
    forces, motion : ndarray, shape (n_c, 4)
        Along d1, d2 and n, and about n [N, N m]; J delta_q [m, rad].

    Returns
    -------
    ndarray, shape (n_c, 4, dimensions)
    """
    loaded = np.flatnonzero(forces[:, 2] > NULL * forces[:, 2].max(initial=0.0))
    if not loaded.size:
        return np.zeros((len(forces), 4, 0))
    J_n, J_1, J_2, J_w = frame_jacobian(contacts, contacts.J)
    frames = np.stack([J_1, J_2, J_n, J_w], axis=1)  # as forces are
    mu = contacts.mu
    d1, d2 = (np.vecdot(motion[:, :3], d) for d in (contacts.d1, contacts.d2))
    slips = (np.hypot(d1, d2) > NULL) | ((mu[:, 2] > 0) & (np.abs(motion[:, 3]) > NULL))
    columns = []
    for j in loaded.tolist():
        if mu[j].any() and slips[j]:
            columns.append((j, forces[j] / forces[j, 2]))
        else:
            rubs = [0, 1] if mu[j, 0] > 0 else []
            rubs = [*rubs, 2, *([3] if mu[j, 2] > 0 else [])]
            columns += [(j, np.eye(4)[i]) for i in rubs]
    z = np.array([column for _, column in columns])
    of = np.array([j for j, _ in columns])
    rows = np.einsum("ki,kiv->kv", z, frames[of])
    rows = rows / np.maximum(np.abs(rows).max(axis=0), 1e-300)
    _, sizes, vt = np.linalg.svd(rows.T)
    null = vt[int((sizes > NULL * sizes[0]).sum()) :].T
    inner = np.zeros((len(forces), 4, null.shape[1]))
    np.add.at(inner, of, z[:, :, None] * null[:, None, :])
    return inner


class Part(NamedTuple):
    """A group of a step that is looked at.

    Parameters
    ----------
    look : Look
    whole, step : StepData
        Of all that touches or presses, and of the group, from where its bodies have come down.
    coordinates, at : ndarray of int
        Its entries of delta_q, and its contacts.
    bodies : list of Body
    """

    look: Look
    whole: StepData
    step: StepData
    coordinates: Indices
    at: Indices
    bodies: list[Body]

    @property
    def names(self) -> set[str]:
        """Of its bodies."""
        return {body.name for body in self.bodies}

    def note(self, law: str, answer: slowly.Answer) -> None:
        """Keep what its contacts do by a law."""
        look = self.look
        if law not in look.laws:
            of_all = np.where(look.live[:, None], np.nan, 0.0)
            look.laws[law] = Law(np.tile(of_all, 4), np.tile(of_all, 4))
        look.laws[law].forces[self.at] = answer.forces
        look.laws[law].motion[self.at] = self.step.contacts.motion(answer.delta_q)


class Groups:
    """The groups of a step that is looked at.

    Parameters
    ----------
    run : Run
    look : Look

    Attributes
    ----------
    whole : StepData
        Of all that touches or presses.
    delta_q : ndarray, shape (n_v,)
        The run's.
    of : dict of str to list of (Group, ndarray of int, list of Body)
        Of each body or pair: its groups, with their contacts among all of the run and bodies.
    """

    def __init__(self, run: Run, look: Look) -> None:
        self.look = look
        step = run.posed(look.k)
        live = np.flatnonzero(look.live)
        every = np.arange(step.n_v)
        self.delta_q = run.delta_q_of(look.k, step.n_v)
        reach = np.abs(step.extra.A) @ np.abs(self.delta_q)
        near = np.flatnonzero(-step.extra.b <= reach + 1e-12)
        self.whole = step.replace(
            contacts=step.contacts.some(live, every), extra=step.extra.of(near, every)
        )
        of = {i: body for body in run.bodies_of for i in body.coordinates.tolist()}
        self.of: dict[str, list[tuple[Group, Indices, list[Body]]]] = {}
        for group in groups(self.whole):
            at = live[group.contacts]
            moved = dict.fromkeys(of[i] for i in group.coordinates.tolist() if i in of)
            names = {body.name for body in moved} | {run.pairs[i].name for i in run.pair_of[at]}
            for name in names:
                self.of.setdefault(name, []).append((group, at, [*moved]))


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
        self._last: Groups | None = None
        self._kept: dict[bytes, slowly.Slow] = {}

    def at(self, k: int, name: str, corners: bool = False) -> Look:
        """A look at step k, of the groups of a body or a pair.

        Parameters
        ----------
        k : int
        name : str
        corners : bool
            Whether the round cone is asked.
        """
        run = self.run
        if k not in self.looks:
            live = (run["phi"][k] <= TOUCHES * run.sizes) | run.presses[k]
            of_run = Law(np.asarray(run["wrench"][k]), run.noted("moved")[k])
            self.looks[k] = Look(k, {RUN: of_run}, live)
        self._solve(self.looks[k], name, corners)
        return self.looks[k]

    def alone(self, k: int, body: Body, contacts: Mask) -> Look:
        """Step k as if a body had some of its contacts alone."""
        look = Look(k, {}, contacts & self.run.presses[k])
        self._solve(look, body.name, False)
        return look

    def _solve(self, look: Look, name: str, corners: bool) -> None:
        run = self.run
        if self._last is None or self._last.look is not look:
            self._last = Groups(run, look)
        groups = self._last
        for group, at, bodies in groups.of.get(name, ()):
            of = {body.name for body in bodies}
            if look.asked[at].any() or any(x in look.bodies or x in look.lost for x in of):
                continue
            look.asked[at] = True
            if 4 * len(at) * len(group.coordinates) > GROUP:
                look.large |= of
                continue
            try:
                part = group_step(groups.whole, group)
                delta_q = groups.delta_q[group.coordinates]
                part = slowly.landed(part, run.presses[look.k, at], delta_q)
                self._group(Part(look, groups.whole, part, group.coordinates, at, bodies), corners)
            except QuasistaticError:  # a step that has no solution, or no float64
                look.lost |= of

    def _group(self, part: Part, corners: bool) -> None:
        look = part.look
        slow = self._slow(part)
        first = slow.first
        climbed = slow.climbed
        if climbed.open:
            look.lost |= part.names
            return
        look.bodies |= part.names
        last = climbed.rungs[-1]
        self._missing(part, SLOW, climbed)
        if last.answer.creeps or (first is not None and first.answer.creeps):
            return
        part.note(SLOW, last.answer)
        self._inner(part)
        if first is not None:
            part.note(COULOMB, first.answer)
            if RUN in look.laws and self._differs(part):
                part.note(MODEL, slow.answer(last.T))
        asked = corners or part.names & look.missing[SLOW].keys()
        name = part.step.cone
        if cone(name).polyhedral and name != "frictionless" and not slow.sticks(last) and asked:
            self._in_round(part, slow)

    def _slow(self, part: Part) -> slowly.Slow:
        """What is asked of a group, or of one that is alike."""
        sizes = self.run.sizes[part.at]
        key = slowly.alike(part.step, sizes)
        if key not in self._kept:
            kept = [*self._kept.items()][-KEPT:]
            self._kept = {**dict(kept), key: slowly.Slow(part.step, self.solvers, sizes)}
        return self._kept[key]

    def _in_round(self, part: Part, slow: slowly.Slow) -> None:
        try:
            climbed = slow.in_round
        except QuasistaticError:  # no optional/ellipsoid, or no solution
            return
        if not climbed.open:
            part.note(ROUND, climbed.rungs[-1].answer)
            self._missing(part, ROUND, climbed)

    def _differs(self, part: Part) -> bool:
        """Whether Coulomb's law has other forces than the run."""
        run, coulomb = (part.look.laws[law].forces[part.at, 2] for law in (RUN, COULOMB))
        return bool(np.abs(run - coulomb).max(initial=0.0) > 0.01 * np.abs(run).max(initial=0.0))

    def _missing(self, part: Part, law: str, climbed: slowly.Climb) -> None:
        n_a = part.whole.n_a
        of_u = part.coordinates[part.step.n_a :]
        for body in part.bodies:
            if body.free and not body.contacts[part.at].any():
                continue  # it falls freely, which is said elsewhere
            here = np.isin(body.coordinates, of_u)
            r = np.zeros(len(here))
            places = np.searchsorted(of_u, body.coordinates[here])
            r[here] = slowly.missing(part.step, climbed, places)
            lacks = body.missing(r, body.inertia(part.whole.M_u, n_a))
            if lacks.amount > slowly.LITTLE * self.run.loads[body][part.look.k]:
                part.look.missing[law][body.name] = lacks

    def _inner(self, part: Part) -> None:
        """Note how far inner loads change the resultants of each pair."""
        forces, motion = (x[part.at] for x in part.look.laws[SLOW])
        inner = inner_loads(part.step.contacts, forces, motion)
        of = self.run.pair_of[part.at]
        for i in np.unique(of).tolist():
            axes = self.run.axes(part.look.k, part.at[of == i])
            part.look.inner[i] = resultants(axes, inner[of == i])
