r"""Slow steps of a group by Coulomb's law: a long T takes the place of h.

With T >> h the drag of a motion that is asked for vanishes, and what nothing bears goes with T^2.
So of two times T_1 < T_2

.. math:: r = -M_u (\delta q_2 - \delta q_1) / (T_2^2 - T_1^2)

is missing: what lands, gives way or is carried on has moved as far at both. It is an answer where
it is the same for two pairs of times.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from typing import NamedTuple, Protocol

import numpy as np

from quasistatic_ref.certify.groups import Group, labels
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.numbers.arrays import Array, Indices, read_only
from quasistatic_ref.optional.stands.bodies import Body, Missing
from quasistatic_ref.parts import is_there
from quasistatic_ref.parts import part as part_of
from quasistatic_ref.solve.backends import DAQP, Certify
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import frame_jacobian
from quasistatic_ref.text.quoting import one_line
from quasistatic_ref.tolerances import ACCURACY

FIRST = 1e-3
"""Part of the smallest body that falls in the first time at once [-],"""
FALLS = 9.81
"""with the earth's acceleration, whatever a scene's is [m/s^2]."""
FACTOR = 3.0
"""From one T to the next [-]."""
LONGEST = 10.0
"""Longest T that is asked, over the first one [-], but for the last factor."""
SHORTER = 6
"""Shorter times T that are asked, at most."""
SAME = 0.01
"""Difference of what two pairs of times say is missing [-], up to which they agree."""
LITTLE = 1e-3
"""Force that is none, over the load of a body [-]."""
ROUNDING = 1e-9
"""Load that is none, over the weight of a body [-]."""
STRAIGHT = 0.1
"""Motion of a body over its size [-] up to which a step is straight."""
OWN = 1e-9
"""Difference of s from its own slip's norm, over the longest motion [-], of a fixed point."""
STICKS = 1e-3
"""Slip over the longest motion of a contact that sticks [-]."""
STILL = 1e-6
"""Acceleration over the largest of a group [-] of a body that stays."""
FACETS = "facets-32"
"""A round cone as a polygon: with torsion, as the product of two."""
HEAVY = (2.0**14, 2.0**10, 2.0**7)
"""Mass of a body that a clamp holds, over the largest of its group [-]: the first that has an
answer."""


class CoulombStep(Protocol):
    """The end of an iteration of ``optional/coulomb``."""

    @property
    def converged(self) -> bool:
        """Whether it is a fixed point."""

    @property
    def s(self) -> Array:
        """By how much phi was raised, shape (n_c,) [m]."""

    @property
    def delta_q(self) -> Array:
        """Its motion, shape (n_v,) [m, rad]."""

    @property
    def wrench(self) -> Array:
        """Forces of contacts, shape (n_c, 4) [N, N m]."""


FixedPoint = Callable[[StepData, Array, Solver, float, Certify, float, float], CoulombStep]


def as_polygon(name: str) -> str:
    """A friction cone, or what stands for a round one, in which no fixed point is exact."""
    return name if cone(name).polyhedral else FACETS


class NoFixedPoint(QuasistaticError):
    """No solution of Coulomb's law was found at some T."""


class Slow(NamedTuple):
    """One slow step.

    Parameters
    ----------
    T : float
        In the place of h [s].
    delta_q : ndarray, shape (n_v,)
        Its motion [m, rad].
    wrench : ndarray, shape (n_c, 4)
        Along d1, d2 and n, and about n [N, N m].
    s : ndarray, shape (n_c,)
        By how much phi was raised [m].
    """

    T: float
    delta_q: Array
    wrench: Array
    s: Array


def slow_step(
    step: StepData,
    T: float,
    s: Array | None = None,
    solvers: list[Solver] | None = None,
    certify: str = "off",
    least: float = 0.0,
) -> Slow:
    """A step by Coulomb's law with T [s] in the place of h, sought from s, (n_c,) [m].

    Parameters
    ----------
    step, T, s
        As above; s is 0 by default.
    solvers : list of Solver, optional
        Those of other steps, which serve again.
    certify : str
        ``"full"``: the end is proved; ``"off"``.
    least : float
        Motion next to which differences of s count [m], if all are shorter.

    Raises
    ------
    NoFixedPoint
        If no solution is found.
    """
    solvers = [] if solvers is None else solvers
    extra = step.extra
    if extra.cost is not None:  # which grows with the time step, as that of a spring
        H, g = extra.cost
        extra = replace(extra, H=T / step.h * H, g=T / step.h * g)
    step = step.with_fields(h=T, extra=extra, cone=as_polygon(step.cone))
    solver = next((one for one in solvers if one.fits(step)), None)
    if solver is None:
        solver = solver_for(step, DAQP if is_there("daqp_solver") else None)
        solvers.append(solver)
    s = np.zeros(step.contacts.n_c) if s is None else s
    of: FixedPoint = part_of("coulomb_from")
    end = of(step, s, solver, ACCURACY, "off", OWN, least)
    if certify == "full" and end.converged:
        end = of(step, end.s, solver, ACCURACY, "full", OWN, least)
    if not end.converged:
        raise NoFixedPoint("no solution of Coulomb's law was found")
    return Slow(T, end.delta_q, end.wrench, end.s)


class Answer(NamedTuple):
    """Whether a body stands, what it lacks, or why that is not known.

    Parameters
    ----------
    stands : bool or None
    lacks : Missing or None
        What it lacks, where that is known.
    with_it : tuple of str
        Others of one verdict with it.
    reason : str
        Why something is not known.
    """

    stands: bool | None
    lacks: Missing | None = None
    with_it: tuple[str, ...] = ()
    reason: str = ""


class SlowGroup:
    """A group of a scene, and the bodies in it.

    Parameters
    ----------
    group : Group
    part : StepData
        As a step of its own, with the h of the scene.
    bodies : sequence of Body
    pair_of : ndarray of int, shape (n_c,)
        The pair of each contact of the group.
    g : float
        [m/s^2]
    solvers : list of Solver
        Those of other groups, which serve again.
    certify : str
        ``"full"``: ends are proved; ``"off"``.
    """

    def __init__(
        self,
        group: Group,
        part: StepData,
        bodies: list[Body],
        pair_of: Indices,
        g: float,
        solvers: list[Solver],
        certify: str,
    ) -> None:
        self.part = part
        self.pair_of = pair_of
        self.solvers = solvers
        self.certify = certify
        at = group.coordinates
        self.bodies = {body: np.searchsorted(at, body.coordinates) for body in bodies}
        self.g = g
        self.rounding = ROUNDING * g * np.array([body.mass for body in bodies])
        self.fall = float(np.max([self._own_load(body) / body.mass for body in bodies]))  # [m/s^2]

    def _slow(self, T: float, s: Array, part: StepData | None = None) -> Slow:
        """The step of a part, by default the group, at T from s."""
        step = self.part if part is None else part
        least = self.fall * T**2
        return slow_step(step, T, s, self.solvers, self.certify, least)

    def _starts(self, first: Slow, last: Slow) -> Array:
        """What goes with T^2, over T^2, turned round, (n_v,) [m/s^2, rad/s^2]."""
        return (first.delta_q - last.delta_q) / (last.T**2 - first.T**2)

    def _inertia(self, body: Body) -> Array:
        """The block of M_u of a body."""
        at = self.bodies[body] - self.part.n_a
        return self.part.M_u[np.ix_(at, at)]

    def _amounts(self, starts: Array) -> Array:
        """Sizes of M_u starts on each body [N]."""
        return np.array([self._size(body, starts) * body.mass for body in self.bodies])

    def _size(self, body: Body, x: Array) -> float:
        """Root mean square of a body's points in a motion x, (n_v,) [of x's unit of length]."""
        own = x[self.bodies[body]]
        return float(np.sqrt(max(float(own @ self._inertia(body) @ own), 0.0) / body.mass))

    def _ways(self, slow: Slow) -> Array:
        """How far each body moves [m], a root mean square over its points."""
        return np.array([self._size(body, slow.delta_q) for body in self.bodies])

    def _loads(self, slow: Slow) -> Array:
        """The load of each body: gravity and others, or if none the largest force of a pair [N]."""
        part = self.part
        normal = slow.wrench[:, 2]
        loads = []
        for body, at in self.bodies.items():
            on = part.contacts.J[:, :, at].any(axis=(1, 2))
            pairs = np.bincount(self.pair_of[on], normal[on])
            own = self._own_load(body)
            least = ROUNDING * self.g * body.mass
            loads.append(own if own > least else float(pairs.max(initial=0.0)))
        return np.array(loads)

    def _own_load(self, body: Body) -> float:
        """What gravity and other loads are on a body [N]."""
        tau = self.part.tau_u[self.bodies[body] - self.part.n_a]
        return float(body.amount(self._inertia(body), tau))

    def answers(self, T: float | None) -> dict[Body, Answer]:
        """What each body lacks, or why that is not known; T is asked first [s], None: at once."""
        try:
            return self._soon() if T is None else self._answers(T)
        except QuasistaticError as error:
            return dict.fromkeys(self.bodies, Answer(None, reason=one_line(str(error))))

    def _answers(self, T: float) -> dict[Body, Answer]:
        sizes = np.array([body.size for body in self.bodies])
        steps = self._first(T / FACTOR**2)
        while True:
            last = steps[-1]
            if len(steps) > 2:
                first, here = self._starts(*steps[-3:-1]), self._starts(*steps[-2:])
                least = np.maximum(LITTLE * self._loads(last), self.rounding)
                before, amounts = self._amounts(first), self._amounts(here)
                off = self._amounts(here - first)
                same = off <= SAME * np.maximum(amounts, least)
                little = amounts <= least
                far = self._ways(last) > STRAIGHT * sizes
                settled = same | little | far
                if last.T >= T and (settled.all() or last.T > LONGEST * T):
                    break
            try:
                steps.append(self._longer(last))
            except NoFixedPoint:
                if len(steps) < 3:
                    raise
                break
        grows = (amounts > before) & (before > least)
        lacks = ~little & (same | grows)
        joined = self._one_verdict(last, here)
        early = steps[:2]
        if (grows & ~same & ~little).any() or (far & ~lacks).any():
            early = self._at_once(steps[0])
        once = self._amounts(self._starts(*early))
        answers: dict[Body, Answer] = {}
        for i, body in enumerate(self.bodies):
            of_one = joined == joined[i]
            if lacks[of_one].any():
                names = (
                    one.name for one, with_it in zip(self.bodies, of_one, strict=True) if with_it
                )
                lack = self._clamped(body, steps[-2:] if same[i] else early)
                open_part = "" if lack else "what a clamp would bear is not known"
                others = tuple(name for name in names if name != body.name)
                answers[body] = Answer(False, lack, others, open_part)
            elif far[i] and once[i] > least[i]:
                way = f"gives way by {1e3 * self._ways(last)[i]:.3g} mm first"
                answers[body] = Answer(None, reason=f"{way}; {once[i]:.4g} N at once")
            elif little[i] or far[i]:
                answers[body] = Answer(True)
            else:
                answers[body] = Answer(None, reason=f"still gives way after {last.T:.3g} s")
        return answers

    def _soon(self) -> dict[Body, Answer]:
        """What each body lacks at once, before springs and landings bear it."""
        T = math.sqrt(FIRST * min([body.size for body in self.bodies]) / FALLS)
        first = self._slow(T, np.zeros(self.part.contacts.n_c))
        steps = [first, self._longer(first)]
        lacks = self._amounts(self._starts(*steps)) > LITTLE * self._loads(steps[1])
        clamps = {one: self._clamped(one, steps) if off else None
                  for one, off in zip(self.bodies, lacks.tolist(), strict=True)}  # fmt: skip
        return {body: Answer(lack is None, lack) for body, lack in clamps.items()}

    def _first(self, T: float) -> list[Slow]:
        """The step at T from s = 0, or at the first shorter T for which there is one."""
        s = np.zeros(self.part.contacts.n_c)
        for _ in range(SHORTER):
            with suppress(NoFixedPoint):
                return [self._slow(T, s)]
            T /= FACTOR
        return [self._slow(T, s)]

    def _longer(self, slow: Slow) -> Slow:
        """The step at the next T, from the s of the last one, or from s = 0."""
        with suppress(NoFixedPoint):
            return self._slow(FACTOR * slow.T, FACTOR**2 * slow.s)
        return self._slow(FACTOR * slow.T, 0.0 * slow.s)

    def _at_once(self, slow: Slow) -> list[Slow]:
        """Two steps before bodies have moved far: from them on, what is missing stays the same."""
        last = slow
        amounts = np.zeros(len(self.bodies))
        for _ in range(SHORTER):
            first = self._slow(last.T / FACTOR, last.s / FACTOR**2)
            pair = [first, last]
            before, amounts = amounts, self._amounts(self._starts(*pair))
            if (np.abs(amounts - before) <= SAME * amounts).all():
                break
            last = first
        return pair

    def _one_verdict(self, slow: Slow, starts: Array) -> Indices:
        """A label of each body, (bodies,): one of those that press without slipping, and move."""
        contacts = self.part.contacts
        J = contacts.J
        J_1, J_2 = frame_jacobian(contacts, J)[1:3]
        slips = np.maximum(np.abs(J_1 @ slow.delta_q), np.abs(J_2 @ slow.delta_q))
        longest = (np.abs(J) @ np.abs(slow.delta_q)).max(initial=0.0)
        sticks = (slow.wrench[:, 2] > 0) & (slips <= STICKS * longest)
        amounts = np.array([self._size(body, starts) for body in self.bodies])
        moves = amounts > STILL * amounts.max(initial=0.0)
        on = [J[sticks][:, :, at].any(axis=(1, 2)) for at in self.bodies.values()]
        joins = np.array(on).reshape(len(self.bodies), int(sticks.sum())) & moves[:, None]
        return labels(joins.T)[0]

    def _clamped(self, body: Body, steps: list[Slow]) -> Missing | None:
        """What a clamp on a body alone would bear: its inertia is made large; None if not known."""
        if len(self.bodies) == 1:  # its own first motion says the same
            return body.missing(self._starts(*steps)[self.bodies[body]], self._inertia(body))
        largest = max([one.mass for one in self.bodies]) / body.mass
        for heavy in HEAVY:
            with suppress(NoFixedPoint):
                return self._held(body, steps, heavy * largest)
        return None

    def _held(self, body: Body, steps: list[Slow], inertia: float) -> Missing:
        """What bears a body whose inertia is so many times its own.

        It begins where all has landed and given way, by the motion that does not go with T^2.
        """
        part = self.part
        last = steps[-1]
        way = last.delta_q + self._starts(*steps) * last.T**2
        n_a = part.n_a
        contacts = part.contacts
        extra = part.extra
        if extra.cost is not None:
            H, g = extra.cost
            extra = replace(extra, g=g - H @ way)
        at = self.bodies[body] - n_a
        M_u = np.array(part.M_u)
        M_u[np.ix_(at, at)] *= inertia
        J_n = frame_jacobian(contacts, contacts.J)[0]
        heavy = part.with_fields(
            M_u=read_only(M_u),
            delta_q_bar_a=part.delta_q_bar_a - way[:n_a],
            contacts=contacts.raised(J_n @ way),
            extra=replace(extra, b=extra.b - extra.A @ way),
        )
        first, last = (self._slow(step.T, 0.0 * step.s, heavy) for step in steps)
        starts = self._starts(first, last)[self.bodies[body]]
        return body.missing(starts, M_u[np.ix_(at, at)])
