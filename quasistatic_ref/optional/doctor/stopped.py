r"""What bodies lack if targets and loads stop after a step: the scene is asked whether it stays.

One step of T = 10 s by Coulomb's law (:mod:`~quasistatic_ref.optional.doctor.slow`) has the
contacts that a straight step may reach. What then neither slips nor moves far is held. Else T
climbs. Where the loads of a body are not borne, its motion goes with T^2, while that of what lands
stays. So two T, T_1 < T_2, say what is missing:

.. math:: r = -M_u\,(\delta q_2 - \delta q_1) / (T_2^2 - T_1^2).

What comes to rest, but not on a straight way, goes a straight way first, and is asked again.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.optional.doctor.artifacts import quotient
from quasistatic_ref.optional.doctor.scenes import Scene
from quasistatic_ref.optional.doctor.slow import SAME, SLOWLY, STRAIGHT, Rung, Slow
from quasistatic_ref.optional.doctor.undecided import NO_ANSWER, TOO_MANY, failure

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Array, Indices, Mask
    from quasistatic_ref.optional.doctor.bodies import Body, Missing
    from quasistatic_ref.optional.doctor.run import Run

NOISE = 1e-6
"""Part of that which rounding leaves of a body that is held [-]."""
ROUNDS = 12
"""Straight ways of a scene that comes to rest."""


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
    every = run.bodies_of
    left = np.array([*(body in bodies for body in every), False])
    q = run["q"][k + 1]
    straight = 1.0
    foreseen = None
    for _ in range(ROUNDS):
        try:
            scene = Scene(run, k, q, run.gap[k], None, cone, contacts)
        except QuasistaticError as error:  # no normal, or no float64
            return lacks | dict.fromkeys((every[i] for i in np.flatnonzero(left)), failure(error))
        if foreseen is not None:
            as_foreseen = (np.abs(scene.every.phi - foreseen) <= SAME * run.sizes).all()
            straight = 3 * straight if as_foreseen else 1.0
        way = np.zeros(scene.step.n_v)
        goes_on = np.zeros_like(left)
        for slow in scene.parts:
            of = np.unique(slow.group_of[left[slow.body_of]])
            if not of.size:
                continue
            if slow.large:
                lacks |= dict.fromkeys((every[i] for i in slow.bodies_in(of)), TOO_MANY)
                continue
            answer = Answer(slow, of, straight)
            unknown = slow.bodies_in(answer.of[answer.unknown])
            lacks |= dict.fromkeys((every[i] for i in unknown), NO_ANSWER)
            for m in np.flatnonzero(answer.lacks).tolist():
                lack = answer.missing(m, every[slow.body_of[m]])
                if lack.amount > slow.least[m]:  # also alone, not with what others move of it
                    lacks[every[slow.body_of[m]]] = lack
            goes = answer.of[answer.goes_on]
            for m in slow.members_of(goes).tolist():
                first.setdefault(every[slow.body_of[m]], answer.missing(m, every[slow.body_of[m]]))
            goes_on[slow.bodies_in(goes)] = True
            way[slow.groups.coordinates[goes]] = answer.way
        left &= goes_on
        if not left.any():
            return lacks
        motion = scene.every.motion(way)[:, :3]
        foreseen = scene.every.phi + np.vecdot(scene.every.n, motion)
        q = run.system.integrate(q, way[: run.system.n_v])
    return lacks | {every[i]: first[every[i]] for i in np.flatnonzero(left)}  # it goes on and on


class Answer:
    """What is known of groups that do not stay as they are, of all that are alike.

    Parameters
    ----------
    slow : Slow
    of : ndarray of int, shape (b,)
        Which groups of it are asked.
    straight : float
        How far they may move, over what is straight [-].

    Attributes
    ----------
    of : ndarray of int, shape (b,)
        Those that do not.
    unknown, goes_on : ndarray of bool, shape (b,)
        Of which it is not known; and which come to rest, but not on a straight way.
    lacks : ndarray of bool, shape (members,)
        Bodies of them whose loads are not borne.
    """

    def __init__(self, slow: Slow, of: Indices, straight: float) -> None:
        self._slow = slow
        self._straight = straight
        last = slow.last(of)
        up = ~self._held(of, last)
        climb = slow.climb(of[up], last.some(up))
        moves = ~self._held(of[up], climb.last)
        self.of = of[up][moves]
        self._starts = climb.starts[moves]
        self._last = climb.last.some(moves)
        ends = (slow.end <= self._last.T) | (self._last.moves > 1)
        known = (climb.count[moves] > 1) & ends
        before, end = (
            self._sizes(self.of, rung) for rung in (climb.before.some(moves), self._last)
        )
        T_before, T = (slow.of_members(x, self.of) for x in (climb.before.T[moves], self._last.T))
        falls = (end * T >= before * T_before) & (end > NOISE * slow.least)
        falls &= slow.of_members(known, self.of) > 0
        self.unknown = ~known
        self.lacks = falls & (slow.amounts(self._starts, self.of) > slow.least)
        self.goes_on = known & slow.all_of(~falls, self.of) & (self._last.moves > straight)

    def _sizes(self, of: Indices, rung: Rung) -> Array:
        """Amounts of r of each body [N]."""
        slow = self._slow
        T = slow.of_members(rung.T, of)
        return quotient(slow.amounts(rung.delta_q[:, slow.groups.n_a :], of), T**2)

    def _held(self, of: Indices, rung: Rung) -> Mask:
        """In which groups nothing moves far, or lacks much, shape (b,).

        What is missing of a body is little, or that of a motion by less than a tenth of its size.
        """
        slow = self._slow
        T = slow.of_members(rung.T, of)
        short = slow.mass * STRAIGHT * quotient(slow.size, T**2)
        stays = (T >= SLOWLY / 10) & (self._sizes(of, rung) <= np.maximum(slow.least, short))
        return rung.found & (rung.moves <= self._straight) & slow.all_of(stays, of)

    @property
    def way(self) -> Array:
        """The first straight part of the motions of groups that go on, (k, n) [m, rad]."""
        goes = self._last.some(self.goes_on)
        return goes.delta_q * (self._straight / goes.moves)[:, None]

    def missing(self, member: int, body: Body) -> Missing:
        """What a body lacks in its group."""
        slow = self._slow
        g = slow.group_of[member]
        at = np.flatnonzero(slow.member[g] == member)
        starts = self._starts[np.searchsorted(self.of, g), at]
        return body.missing(starts, slow.groups.M_u[g][np.ix_(at, at)])
