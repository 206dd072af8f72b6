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
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from quasistatic_ref.certify.groups import Group
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.exact.components import components
from quasistatic_ref.numbers.arrays import Array, Indices, Mask, read_only
from quasistatic_ref.optional.stands.bodies import Body
from quasistatic_ref.parts import is_there
from quasistatic_ref.parts import part as part_of
from quasistatic_ref.quoting import one_line
from quasistatic_ref.simulate.standing import Standing
from quasistatic_ref.solve.backends import DAQP
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import frame_jacobian
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
ROUGH = 0.1
"""The same of short times, where springs have given and nothing has moved far."""
LITTLE = 1e-3
"""Acceleration over the earth's [-] below which what starts counts as at rest, in any scene."""
STRAIGHT = 0.1
"""Motion of a body over its size [-] up to which a step is straight."""
OWN = 1e-9
"""Difference of s from its own slip's norm, over the longest motion [-], of a fixed point."""
OWN_IN_ROUND = 1e-7
"""The same in a round cone, whose solvers are less accurate."""
STICKS = 1e-3
"""Slip over the longest motion of a contact that sticks [-]."""
NO_FORCE = 1e-300
"""In the place of a force of zero, by which nothing is divided [N]."""
STILL = 1e-6
"""Acceleration over the largest of a group [-] of a body that stays."""
FACETS = "facets-32"
"""A polygon inside of a round cone: what stands in it stands in the cone."""
HEAVY = 2.0**14
"""Mass of a body that a clamp holds, over the largest of its group [-]. What is read is short by
m / (m + HEAVY) where a mass m leans on it; by a wedge that nearly jams, of 200 times that mass."""


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
    step = step.with_fields(h=T, extra=extra)
    polyhedral = cone(step.cone).polyhedral
    own = OWN if polyhedral else OWN_IN_ROUND
    solver = next((one for one in solvers if one.fits(step)), None)
    if solver is None:
        solver = solver_for(step, DAQP if polyhedral and is_there("daqp_solver") else None)
        solvers.append(solver)
    s = np.zeros(step.contacts.n_c) if s is None else s
    of: Callable[..., Any] = part_of("coulomb_from")
    end = of(step, s, solver, ACCURACY, "off", own, least)
    if certify == "full" and end.converged:
        end = of(step, end.s, solver, ACCURACY, "full", own, least)
    if not end.converged:
        raise NoFixedPoint("no solution of Coulomb's law was found")
    return Slow(T, end.delta_q, end.wrench, end.s)


class SlowGroup:
    """A group of a scene, and the bodies in it.

    Parameters
    ----------
    group : Group
    part : StepData
        As a step of its own, with the h of the scene.
    bodies : list of Body
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
        solvers: list[Solver],
        certify: str,
    ) -> None:
        self.part = part
        self.bodies = bodies
        self.solvers = solvers
        self.certify = certify
        u = group.coordinates[part.n_a :]
        self.masses = np.array([body.mass for body in bodies])
        self.sizes = np.array([body.size for body in bodies])
        self.own: Mask = np.array([np.isin(u, body.coordinates) for body in bodies])
        moved = part.contacts.J[:, :, part.n_a :].any(axis=1)
        self.touches: Mask = np.asarray(moved @ self.own.T)  # contacts, of bodies
        self.least = LITTLE * FALLS * self.masses  # [N]
        self.loads = self._amounts(np.asarray(np.linalg.solve(part.M_u, part.tau_u), np.float64))

    def _slow(self, T: float, s: Array, part: StepData | None = None) -> Slow:
        """The step of a part, by default the group, at T from s."""
        least = float((self.loads / self.masses).max()) * T**2  # as far as it might fall
        return slow_step(part or self.part, T, s, self.solvers, self.certify, least)

    def _starts(self, first: Slow, last: Slow) -> Array:
        """Minus the part of delta_q that grows with T^2, over T^2, (n_u,) [m/s^2, rad/s^2]."""
        return (first.delta_q - last.delta_q)[self.part.n_a :] / (last.T**2 - first.T**2)

    def _ways(self, x: Array) -> Array:
        """Root mean squares of points of each body in a motion x, (n_u,) [x's unit of length]."""
        twice_energy = self.own @ (x * (self.part.M_u @ x))
        return np.asarray(np.sqrt(np.maximum(twice_energy, 0.0) / self.masses))

    def _amounts(self, starts: Array) -> Array:
        """Sizes of M_u starts on each body [N]: of no frame, and for comparing alone."""
        return self.masses * self._ways(starts)

    def rows(self, T: float | None) -> list[Standing]:
        """What each body lacks, or why that is not known; T is asked first [s], None: at once."""
        try:
            return self._at_once() if T is None else self._in_the_end(T)
        except QuasistaticError as error:
            why = one_line(str(error))
            return [Standing(body.name, None, reason=why) for body in self.bodies]

    def _in_the_end(self, T: float) -> list[Standing]:
        steps = [self._first(T / FACTOR**2)]
        try:
            steps.append(self._longer(steps[0]))
            steps.append(self._longer(steps[1]))
        except NoFixedPoint as error:
            return self._till(steps[-1], str(error))
        while True:
            last = steps[-1]
            first, here = self._starts(*steps[-3:-1]), self._starts(*steps[-2:])
            before, amounts = self._amounts(first), self._amounts(here)
            least = self.least
            same = self._amounts(here - first) <= SAME * np.maximum(amounts, least)
            little = amounts <= least
            ways = self._ways(last.delta_q[self.part.n_a :])
            far = ways > STRAIGHT * self.sizes
            done = (same | little | far).all() or last.T > LONGEST * T
            if done and last.T >= T:
                break
            try:
                steps.append(self._longer(last))
            except NoFixedPoint:
                break
        lacks = ~little & (same | (amounts > before) & (before > least))
        gives_way = np.where(lacks, ~same, far)
        early = self._early(steps[0]) if gives_way.any() else steps[:2]
        once = self._amounts(self._starts(*early)) > least
        joined = self._one_verdict(last, here)
        rows = []
        for i, body in enumerate(self.bodies):
            if lacks[joined == joined[i]].any():
                row = self._clamped(i, steps[-2:] if same[i] else early)
                names = [self.bodies[k].name for k in np.flatnonzero(joined == joined[i]) if k != i]
                rows.append(replace(row, held_with=tuple(names)))
                continue
            why = ""
            if far[i] and once[i]:
                lack = self._clamped(i, early).words
                why = f"gives way by {1e3 * ways[i]:.3g} mm first; {lack} at once"
            elif not (little[i] or far[i]):
                why = f"still gives way after {last.T:.3g} s"
            rows.append(Standing(body.name, None if why else True, reason=why))
        return rows

    def _till(self, last: Slow, why: str) -> list[Standing]:
        """How far each body gives way by the last time that is answered, and lacks at once."""
        pairs, changes = self._short(last)
        ways = 1e3 * self._ways(last.delta_q[self.part.n_a :])
        reasons = [f"gives way by {way:.2g} mm in {last.T:.2g} s; then {why}" for way in ways]
        if (agree := np.flatnonzero(changes <= ROUGH)).size:
            early = pairs[agree[0]]
            lacks = self._amounts(self._starts(*early)) > self.least
            for i in np.flatnonzero(lacks).tolist():
                row = self._clamped(i, early)
                force, torque = (float(f"{x:.2g}") for x in (row.missing_N, row.missing_Nm))
                lack = replace(row, missing_N=force, missing_Nm=torque).words
                reasons[i] = f"lacks about {lack} at once; {reasons[i]}"
        rows = zip(self.bodies, reasons, strict=True)
        return [Standing(body.name, None, reason=reason) for body, reason in rows]

    def _at_once(self) -> list[Standing]:
        """What each body lacks at once, before springs and landings bear it."""
        T = math.sqrt(FIRST * self.sizes.min() / FALLS)
        first = self._slow(T, np.zeros(self.part.contacts.n_c))
        steps = [first, self._longer(first)]
        lacks = self._amounts(self._starts(*steps)) > self.least
        return [
            self._clamped(i, steps) if lacks[i] else Standing(body.name, True)
            for i, body in enumerate(self.bodies)
        ]

    def _first(self, T: float) -> Slow:
        """The step at T from s = 0, or at the first shorter T for which there is one."""
        s = np.zeros(self.part.contacts.n_c)
        for shorter in range(SHORTER):
            with suppress(NoFixedPoint):
                return self._slow(T / FACTOR**shorter, s)
        return self._slow(T / FACTOR**SHORTER, s)

    def _longer(self, slow: Slow, part: StepData | None = None) -> Slow:
        """The step of a part at the next T, from the s of the last one, or from s = 0."""
        with suppress(NoFixedPoint):
            return self._slow(FACTOR * slow.T, FACTOR**2 * slow.s, part)
        return self._slow(FACTOR * slow.T, 0.0 * slow.s, part)

    def _early(self, slow: Slow) -> list[Slow]:
        """Two steps before bodies have moved far, from which on what is missing stays the same."""
        pairs, changes = self._short(slow)
        return pairs[1 + int(changes.argmin())]

    def _short(self, slow: Slow) -> tuple[list[list[Slow]], Array]:
        """Pairs of shorter and shorter steps, and what is missing's change to the next pair [-]."""
        steps = [slow]
        for _ in range(SHORTER):
            steps.append(self._slow(steps[-1].T / FACTOR, steps[-1].s / FACTOR**2))
        pairs = [[first, last] for last, first in pairwise(steps)]
        amounts = np.array([self._amounts(self._starts(*pair)) for pair in pairs])
        off = np.abs(np.diff(amounts, axis=0)).max(axis=1)
        return pairs, off / np.maximum(amounts[1:].max(axis=1), NO_FORCE)

    def _one_verdict(self, slow: Slow, starts: Array) -> Indices:
        """A label for each body, (bodies,): equal for moving bodies that stick to each other."""
        contacts = self.part.contacts
        _, J_1, J_2, *_ = frame_jacobian(contacts, contacts.J)
        slips = np.maximum(np.abs(J_1 @ slow.delta_q), np.abs(J_2 @ slow.delta_q))
        longest = (np.abs(contacts.J) @ np.abs(slow.delta_q)).max(initial=0.0)
        sticks = (slow.wrench[:, 2] > 0) & (slips <= STICKS * longest)
        ways = self._ways(starts)
        return components(self.touches[sticks] & (ways > STILL * ways.max()))[0]

    def _clamped(self, i: int, steps: list[Slow]) -> Standing:
        """What a clamp that holds one body would bear, found with a large inertia of that body.

        It begins where all has landed and given way, by the motion that does not go with T^2.
        """
        body, own, part = self.bodies[i], self.own[i], self.part
        starts, M_u = self._starts(*steps), part.M_u
        if len(self.bodies) > 1:  # else its own first motion says the same
            M_u = np.where(own[:, None], HEAVY * self.masses.max() / body.mass, 1.0) * M_u
            way = np.array(steps[1].delta_q)
            way[part.n_a :] += starts * steps[1].T ** 2
            heavy = part.with_fields(M_u=read_only(M_u), **after_motion(part, way))
            try:
                first = self._slow(steps[0].T, 0.0 * steps[0].s, heavy)
                starts = self._starts(first, self._longer(first, heavy))
            except NoFixedPoint:
                return Standing(body.name, False, reason="what a clamp would bear is not known")
        return body.missing(starts[own], M_u[np.ix_(own, own)])


def after_motion(step: StepData, way: Array) -> dict[str, Any]:
    """The fields of a step that change where a motion `way`, (n_v,) [m, rad], was done before."""
    extra, contacts = step.extra, step.contacts
    if extra.cost is not None:
        H, g = extra.cost
        extra = replace(extra, g=g - H @ way)
    return {
        "delta_q_bar_a": step.delta_q_bar_a - way[: step.n_a],
        "contacts": contacts.raised(frame_jacobian(contacts, contacts.J)[0] @ way),
        "extra": replace(extra, b=extra.b - extra.A @ way),
    }
