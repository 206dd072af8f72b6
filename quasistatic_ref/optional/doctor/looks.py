"""Steps of a run, each looked at by four laws: what is missing, and what each artifact changes."""

from __future__ import annotations

from contextlib import suppress
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.certify.groups import Group, group_step, groups
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.formats.quoting import listed
from quasistatic_ref.optional.doctor import slowly
from quasistatic_ref.optional.doctor.chosen import PROVED, asked, has_corners
from quasistatic_ref.step.friction import frame_jacobian

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Array, Indices, Mask
    from quasistatic_ref.optional.doctor.bodies import Body, Missing
    from quasistatic_ref.optional.doctor.run import Run
    from quasistatic_ref.step.contacts import Contacts
    from quasistatic_ref.step.data import StepData

RUN, COULOMB, SLOW, ROUND, MODEL = "run", "coulomb", "slow", "round", "model"
"""The run's own law at h; Coulomb's at h, and slowly; that in the ellipsoid; the run's slowly."""
NULL = 1e-9
"""Singular value that is none, over the largest [-]."""
GROUP = 50_000
"""Most entries of J, 4 n_c n_v, of a group that is looked at."""
KEPT = 8
"""Groups whose answers are kept for those that are alike."""
STILL = 0.01
"""What a body that lies still drags, over its own load [-]."""


class Law(NamedTuple):
    """What contacts do by one law.

    Parameters
    ----------
    forces, motion : ndarray, shape (n_c, 4)
        Along d1, d2 and n, and about n [N, N m] and [m, rad]; NaN where it was not asked.
    """

    forces: Array
    motion: Array


class Look:
    """A step of a run by each law.

    Parameters
    ----------
    k : int
    live : ndarray of bool, shape (n_c,)
        Contacts that touch or press.

    Attributes
    ----------
    laws : dict of str to Law
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

    def __init__(self, k: int, live: Mask) -> None:
        self.k = k
        self.live = live
        self.laws: dict[str, Law] = {}
        self.missing: dict[str, dict[str, Missing]] = {SLOW: {}, ROUND: {}}
        self.inner: dict[int, Array] = {}
        self.asked = np.zeros_like(live)
        self.bodies: set[str] = set()
        self.lost: set[str] = set()
        self.large: set[str] = set()

    def knows(self, law: str, contacts: Mask | slice) -> bool:
        """Whether a law has an answer for some contacts, shape (n_c,)."""
        return law in self.laws and bool(np.isfinite(self.laws[law].forces[contacts]).all())

    def note(self, law: str, at: Indices, contacts: Contacts, answer: slowly.Answer) -> None:
        """Keep what some contacts, `at` among all, do by a law."""
        if law not in self.laws:
            of_all = np.where(self.live[:, None], np.nan, np.zeros(4))
            self.laws[law] = Law(of_all, of_all.copy())
        self.laws[law].forces[at] = answer.forces
        self.laws[law].motion[at] = contacts.motion(answer.delta_q)


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
    f_n = forces[:, 2]
    loaded = np.flatnonzero(f_n > NULL * f_n.max(initial=0.0))
    J_n, J_1, J_2, J_w = frame_jacobian(contacts, contacts.J)
    frames = np.stack([J_1, J_2, J_n, J_w], axis=1)[loaded]  # as forces are
    rubs = contacts.mu[loaded] > 0
    d1, d2 = (np.vecdot(motion[:, :3], d)[loaded] for d in (contacts.d1, contacts.d2))
    slips = (np.hypot(d1, d2) > NULL) | (rubs[:, 2] & (np.abs(motion[loaded, 3]) > NULL))
    rays = np.eye(4) * np.insert(rubs, 2, True, axis=1)[:, None]  # in columns; some are nothing
    rays[slips] = 0.0
    rays[slips, :, 2] = (forces[loaded] / f_n[loaded, None])[slips]
    rows = np.einsum("jci,jcv->jiv", rays, frames).reshape(4 * len(loaded), contacts.n_v)
    rows = rows / np.maximum(np.abs(rows).max(axis=0, initial=0.0), 1e-300)
    _, sizes, vt = np.linalg.svd(rows.T)
    null = vt[int((sizes > NULL * sizes.max(initial=0.0)).sum()) :].T
    inner = np.zeros((*forces.shape, null.shape[1]))
    inner[loaded] = np.einsum("jci,jid->jcd", rays, null.reshape(len(loaded), 4, null.shape[1]))
    return inner


class Part(NamedTuple):
    """A group of a step that is looked at.

    Parameters
    ----------
    whole : StepData
        Of all that touches or presses.
    group : Group
        Of that step.
    at : ndarray of int
        Its contacts among all of the run.
    bodies : list of Body
    """

    whole: StepData
    group: Group
    at: Indices
    bodies: list[Body]

    @property
    def names(self) -> set[str]:
        """Of its bodies."""
        return {body.name for body in self.bodies}


class Looking:
    """Looks at steps of a run.

    Parameters
    ----------
    run : Run
    """

    def __init__(self, run: Run) -> None:
        self.run = run
        self.left = 0
        self.solvers = slowly.Solvers()
        self.looks: dict[int, Look] = {}
        self._last: tuple[Look, dict[str, list[Part]]] | None = None
        self._kept: dict[bytes, slowly.Slow] = {}

    @cached_property
    def chosen(self) -> list[Look]:
        """The looks that say most of each body and pair; `left` counts steps beyond the budget."""
        run = self.run
        seen: set[tuple[str, int]] = set()
        known: set[str] = set()
        every = asked(run)
        far = {body.name for body in run.bodies_of if run.gets_far(body)}
        corners = {one.k for one in every if one.corners}
        for one in every:
            if (one.name, one.k) in seen:
                continue
            if self.solvers.proved >= PROVED and one.name not in far - known:
                self.left += 1
                continue
            look = self.at(one.k, one.name, one.k in corners)
            names = {one.name} | look.bodies | look.lost
            known |= names
            seen |= {(name, one.k) for name in names}
        return [self.looks[k] for k in sorted(self.looks)]

    @property
    def not_looked_at(self) -> str:
        """One line on bodies whose looks have no answer, and on what is beyond the budget."""
        looks = self.chosen
        lines = []
        lost = {name for look in looks for name in look.lost}
        if lost := lost - {name for look in looks for name in look.bodies}:
            lines.append(f"equilibrium of {listed(sorted(lost))}: no fixed point was found")
        if large := {name for look in looks for name in look.large}:
            lines.append(f"equilibrium of {len(large)} bodies: too many of them touch")
        if self.left:
            lines.append(f"{self.left} steps with other contacts: {PROVED} proofs were made")
        return "; ".join(lines)

    def lacks(self, name: str) -> list[tuple[Look, Missing]]:
        """The looks in which something is missing of a body."""
        return [(x, x.missing[SLOW][name]) for x in self.chosen if name in x.missing[SLOW]]

    def rests(self, body: Body) -> bool:
        """Whether a body lies still in the last step, and nothing is missing in it.

        What creeps, borne by its layer, hardly moves, but lacks something.
        """
        run = self.run
        if run.drags[body][-1] > STILL * run.loads[body][-1]:
            return False
        if not self.lacks(body.name):
            return True
        last = self.at(run.steps - 1, body.name)
        return body.name not in {*last.missing[SLOW], *last.lost}

    def settles(self, body: Body, first: int = 0) -> bool:
        """Whether a body moves little from a step on, and lies still at the end of the run."""
        return self.rests(body) and not self.run.gets_far(body, first)

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
            self.looks[k] = Look(k, run.live[k])
            self.looks[k].laws[RUN] = Law(np.asarray(run["wrench"][k]), run.noted("moved")[k])
        self._solve(self.looks[k], name, corners)
        return self.looks[k]

    def alone(self, k: int, body: Body, contacts: Mask) -> Look:
        """Step k as if a body had some of its contacts alone."""
        look = Look(k, contacts & self.run.presses[k])
        self._solve(look, body.name, False)
        return look

    def _parts(self, look: Look) -> dict[str, list[Part]]:
        """Of each body or pair its groups in a step; those of the last step are kept."""
        if self._last is not None and self._last[0] is look:
            return self._last[1]
        run = self.run
        step = run.posed(look.k)
        live = np.flatnonzero(look.live)
        every = np.arange(step.n_v)
        reach = np.abs(step.extra.A) @ np.abs(run.delta_q_of(look.k, step.n_v))
        near = np.flatnonzero(-step.extra.b <= reach + 1e-12)
        whole = step.replace(
            contacts=step.contacts.some(live, every), extra=step.extra.of(near, every)
        )
        of = {i: body for body in run.bodies_of for i in body.coordinates.tolist()}
        parts: dict[str, list[Part]] = {}
        for group in groups(whole):
            at = live[group.contacts]
            moved = dict.fromkeys(of[i] for i in group.coordinates.tolist() if i in of)
            names = {body.name for body in moved} | {run.pairs[i].name for i in run.pair_of[at]}
            for name in names:
                parts.setdefault(name, []).append(Part(whole, group, at, [*moved]))
        self._last = look, parts
        return parts

    def _solve(self, look: Look, name: str, corners: bool) -> None:
        for part in self._parts(look).get(name, ()):
            names = part.names
            if look.asked[part.at].any() or names & (look.bodies | look.lost):
                continue
            look.asked[part.at] = True
            if 4 * len(part.at) * len(part.group.coordinates) > GROUP:
                look.large |= names
                continue
            try:
                self._look(look, part, corners)
            except QuasistaticError:  # a step that has no solution, or no float64
                look.lost |= names

    def _look(self, look: Look, part: Part, corners: bool) -> None:
        """Look at a group by all laws."""
        run = self.run
        at = part.at
        step = group_step(part.whole, part.group)
        delta_q = run.delta_q_of(look.k, part.whole.n_v)[part.group.coordinates]
        step = slowly.landed(step, run.presses[look.k, at], delta_q)
        contacts = step.contacts
        slow = self._slow(step, run.sizes[at])
        first = slow.first
        rungs = slow.climbed
        if rungs is None:
            look.lost |= part.names
            return
        look.bodies |= part.names
        self._missing(look, part, SLOW, step, rungs)
        last = rungs[-1]
        if last.answer.creeps or (first is not None and first.answer.creeps):
            return
        look.note(SLOW, at, contacts, last.answer)
        self._note_inner(look, at, contacts)
        if first is not None:
            look.note(COULOMB, at, contacts, first.answer)
            if RUN in look.laws and _differs(look, at):
                look.note(MODEL, at, contacts, slow.answer(last.T))
        asks = corners or part.names & look.missing[SLOW].keys()
        if has_corners(step.cone) and asks and not slow.sticks(last):
            with suppress(QuasistaticError):  # no optional/ellipsoid, or no solution
                if rungs := slow.in_round:
                    look.note(ROUND, at, contacts, rungs[-1].answer)
                    self._missing(look, part, ROUND, step, rungs)

    def _slow(self, step: StepData, sizes: Array) -> slowly.Slow:
        """What is asked of a group, or of one that is alike."""
        key = slowly.alike(step, sizes)
        if key not in self._kept:
            kept = [*self._kept.items()][-KEPT:]
            self._kept = {**dict(kept), key: slowly.Slow(step, self.solvers, sizes)}
        return self._kept[key]

    def _missing(
        self, look: Look, part: Part, law: str, step: StepData, rungs: list[slowly.Rung]
    ) -> None:
        """Note what is missing of the bodies of a group."""
        of_u = part.group.coordinates[step.n_a :]
        for body in part.bodies:
            if body.free and not body.contacts[part.at].any():
                continue  # it falls freely, which is said elsewhere
            here = np.isin(body.coordinates, of_u)
            r = np.zeros(len(here))
            places = np.searchsorted(of_u, body.coordinates[here])
            r[here] = slowly.missing(step, rungs, places)
            lacks = body.missing(r, body.inertia(part.whole.M_u, part.whole.n_a))
            if lacks.amount > slowly.LITTLE * self.run.loads[body][look.k]:
                look.missing[law][body.name] = lacks

    def _note_inner(self, look: Look, at: Indices, contacts: Contacts) -> None:
        """Note how far inner loads change the resultants of each pair."""
        forces, motion = (x[at] for x in look.laws[SLOW])
        inner = inner_loads(contacts, forces, motion)
        of = self.run.pair_of[at]
        for i in np.unique(of).tolist():
            axes = self.run.axes(look.k, at[of == i])
            look.inner[i] = resultants(axes, inner[of == i])


def _differs(look: Look, at: Indices) -> bool:
    """Whether Coulomb's law has other forces than the run, of some contacts."""
    run = look.laws[RUN].forces[at, 2]
    coulomb = look.laws[COULOMB].forces[at, 2]
    return bool(np.abs(run - coulomb).max(initial=0.0) > 0.01 * np.abs(run).max(initial=0.0))
