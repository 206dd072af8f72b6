r"""What bodies lack if targets and loads stop after a step: the scene is asked whether it stays.

One step of T = 10 s by Coulomb's law (:mod:`~quasistatic_ref.optional.doctor.slow`) has the
contacts that a straight step may reach. What then neither slips nor moves far is held. Else T
climbs. Where the loads of a body are not borne, its motion goes with T^2, while that of what lands
stays. So two T, T_1 < T_2, say what is missing:

.. math:: r = -M_u\,(\delta q_2 - \delta q_1) / (T_2^2 - T_1^2).

What comes to rest, but not on a straight way, goes a straight way first, and is asked again.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import suppress
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.certify.groups import Group, group_step, groups
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.optional.doctor.slow import SLOWLY, STRAIGHT, Rung, Slow
from quasistatic_ref.optional.doctor.undecided import NO_ANSWER, TOO_MANY, failure
from quasistatic_ref.parts.solve import posed

if TYPE_CHECKING:
    from quasistatic_ref.contact.distance import ClosestPoints
    from quasistatic_ref.numbers.arrays import Array, Indices, Mask
    from quasistatic_ref.optional.doctor.bodies import Body, Missing
    from quasistatic_ref.optional.doctor.run import Run
    from quasistatic_ref.step.data import StepData

LITTLE = 1e-3
"""Force that is none, over a body's own load [-]."""
NOISE = 1e-6
"""Part of that which rounding leaves of a body that is held [-]."""
SAME = 1e-3
"""Change of r, and of a gap over the smaller shape, that is none [-]."""
ROUNDS = 12
"""Straight ways of a scene that comes to rest."""
GROUP = 50_000
"""Most entries of J, 4 n_c n_v, of a group that is asked."""


class Part(NamedTuple):
    """A group of a scene.

    Parameters
    ----------
    group : Group
    contacts : ndarray of int
        Of it, among all of the run.
    slow : Slow
    """

    group: Group
    contacts: Indices
    slow: Slow

    @property
    def large(self) -> bool:
        """Whether the part is too large for its equilibrium to be checked."""
        return 4 * len(self.contacts) * len(self.group.coordinates) > GROUP


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
    step : StepData
        Of the near contacts and stops.
    phi : ndarray, shape (n_c,)
        Of all contacts [m].
    every : Contacts
        All of them.
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
        step = simulator.step_at(q, run["q_bar_a"][k], run.noted("tau")[k], points)
        if simulator.extension is not None:
            step = posed(step, simulator.extension(q))[0]
        self.phi = points.phi
        self.every = step.contacts
        highest = np.zeros(len(run.pairs))
        np.maximum.at(highest, run.pair_of, np.where(run.touches[k], 1.01 * gap, 0.0))
        reach = np.maximum(STRAIGHT * run.sizes, highest[run.pair_of])
        near = np.flatnonzero(contacts & (points.phi <= reach))
        lengths = np.ones(step.n_v, dtype=bool)  # so are private rises
        lengths[: run.system.n_v] = [c.unit == "m" for c in run.system.coordinates]
        slides = (step.extra.A[:, lengths] != 0).any(axis=1)
        stops = np.where(slides, STRAIGHT * run.sizes.min(initial=1.0), STRAIGHT)
        coordinates = np.arange(step.n_v)
        self.step = step.with_fields(
            contacts=step.contacts.some(near, coordinates), cone=cone or step.cone
        )
        if not step.extra.empty:
            extra = step.extra.of(np.flatnonzero(-step.extra.b <= stops), coordinates)
            self.step = self.step.with_fields(extra=extra)
        self._near = near
        self._sizes = run.sizes[near]
        self._turns = ~lengths & (coordinates >= step.n_a)

    def parts(self) -> Iterator[Part]:
        """The groups of the scene, each as a part."""
        for group in groups(self.step):
            turns = self._turns[group.coordinates]
            slow = Slow(group_step(self.step, group), self._sizes[group.contacts], turns)
            yield Part(group, self._near[group.contacts], slow)


class Member:
    """A body in a group.

    Parameters
    ----------
    body : Body
    step : StepData
        Of all groups.
    part : Part
    load : float
        Of the body [N].
    """

    def __init__(self, body: Body, step: StepData, part: Part, load: float) -> None:
        of_u = part.group.coordinates[part.group.coordinates >= step.n_a]
        self.body = body
        self.M = body.inertia(step.masses, step.n_a)
        self.least = LITTLE * load
        self._slow = part.slow
        self._here = np.isin(body.coordinates, of_u)
        self._at = np.searchsorted(of_u, body.coordinates[self._here])

    def r(self, delta_q: Array, square: float) -> Array:
        """-M_u delta_q_u / T^2 along its coordinates, (n,) [N, N m], of a square T^2 [s^2]."""
        step = self._slow.step
        r = np.zeros(len(self._here))
        r[self._here] = -(step.M_u @ delta_q[step.n_a :])[self._at] / square
        return r

    def stays(self, one: Rung) -> bool:
        """Whether r is little, or is that of a motion by less than a tenth of the body's size."""
        short = self.body.mass * STRAIGHT * self.body.size / one.T**2
        lacks = self.body.amount(self.M, self.r(one.delta_q, one.T**2))
        return one.T >= SLOWLY / 10 and bool(lacks <= max(self.least, short))

    def falls(self, rungs: list[Rung]) -> bool:
        """Whether r falls no faster than 1/T."""
        sizes = [float(self.body.amount(self.M, self.r(x.delta_q, x.T**2))) for x in rungs[-2:]]
        before, end = (size * one.T for size, one in zip(sizes, rungs[-2:], strict=True))
        return end >= before and sizes[-1] > NOISE * self.least

    def missing(self, rungs: list[Rung]) -> Missing:
        """What goes with T^2 from one T to the next.

        It is the first on which two agree, or that of the last which are straight. A joint that
        stays needs none: what it has of M a is a reaction.
        """
        each = [self.r(y.delta_q - x.delta_q, y.T**2 - x.T**2) for x, y in pairwise(rungs)]
        changes = np.diff(each, axis=0, prepend=0.0)
        alike = self.body.amount(self.M, changes) <= SAME * self.body.amount(self.M, np.array(each))
        straight = sum(one.moves <= 1 for one in rungs[1:])
        r = each[int(alike.argmax()) if alike.any() else max(straight - 1, 0)]
        power = np.abs(np.linalg.solve(self.M, r) * r)
        if not self.body.free:
            r = np.where(power > LITTLE * power.sum(), r, 0.0)
        return self.body.missing(r, self.M)


def missing(
    run: Run,
    k: int,
    bodies: Collection[Body],
    cone: str | None = None,
    contacts: Mask | bool = True,
) -> dict[Body, Missing | str]:
    """What bodies lack if targets and loads stop after step k, or why that is not known.

    Parameters
    ----------
    run : Run
    k : int
    bodies : collection of Body
    cone, contacts
        As of :class:`Scene`.
    """
    lacks: dict[Body, Missing | str] = {}
    first: dict[Body, Missing] = {}
    left = {*bodies}
    of = {i: body for body in run.bodies_of for i in body.coordinates.tolist()}
    q = run["q"][k + 1]
    straight = 1.0
    foreseen = None
    for _ in range(ROUNDS):
        try:
            scene = Scene(run, k, q, run.gap[k], None, cone, contacts)
        except QuasistaticError as error:  # no normal, or no float64
            return lacks | dict.fromkeys(left, failure(error))
        if foreseen is not None:
            as_foreseen = (np.abs(scene.phi - foreseen) <= SAME * run.sizes).all()
            straight = 3 * straight if as_foreseen else 1.0
        way = np.zeros(scene.step.n_v)
        goes_on: set[Body] = set()
        for part in scene.parts():
            here = dict.fromkeys(of[i] for i in part.group.coordinates.tolist() if i in of)
            if not left & here.keys():
                continue
            members = [Member(body, scene.step, part, run.loads[body][k]) for body in here]
            rungs = _rungs(part, members, straight)
            if rungs and _held(rungs[-1], members, straight):
                continue
            ends = rungs and (part.slow.end <= rungs[-1].T or rungs[-1].moves > 1)
            if len(rungs) < 2 or not ends:
                lacks |= dict.fromkeys(here, TOO_MANY if part.large else NO_ANSWER)
                continue
            falls = [member for member in members if member.falls(rungs)]
            for member in falls:
                lack = member.missing(rungs)
                if lack.amount > member.least:
                    lacks[member.body] = lack
            if not falls and rungs[-1].moves > straight:
                for member in members:
                    first.setdefault(member.body, member.missing(rungs))
                goes_on |= here.keys()
                way[part.group.coordinates] = rungs[-1].delta_q * (straight / rungs[-1].moves)
        left &= goes_on
        if not left:
            return lacks
        motion = scene.every.motion(way)[:, :3]
        foreseen = scene.phi + np.vecdot(scene.every.n, motion)
        q = run.system.integrate(q, way[: run.system.n_v])
    return lacks | {body: first[body] for body in left}  # it goes on and on


def _rungs(part: Part, members: list[Member], straight: float) -> list[Rung]:
    """The slow steps of a group: the last one if it is held, else its whole climb."""
    slow = part.slow
    rungs: list[Rung] = []
    with suppress(QuasistaticError):  # no solution, or no float64
        if not part.large:
            held = slow.last is not None and _held(slow.last, members, straight)
            rungs = [slow.last] if slow.last is not None and held else slow.climbed
    return rungs


def _held(one: Rung, members: list[Member], straight: float) -> bool:
    """Whether nothing in a group moves far, or lacks much."""
    return one.moves <= straight and all(member.stays(one) for member in members)
