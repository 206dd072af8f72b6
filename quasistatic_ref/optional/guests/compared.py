"""Contacts and bodies of a state: what an engine says of them next to the exact answer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.optional.guests.state_step import StateContact
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.tolerances import CREEP, FORCES_AGREE, STEADY

WINDOW = 0.1
"""Time over which an engine's motion is measured [s]: many of its time steps, and few of a fall."""


@dataclass(frozen=True)
class Bearing:
    """What a contact bears, and how it moves.

    Parameters
    ----------
    normal, friction : float
        Forces [N].
    torque : float
        About the normal [N m].
    share : float
        Of what friction and torque may be at this normal force [-].
    slip : float
        Speed of one surface along the other [m/s].
    spin : float
        Rate about the normal [rad/s].
    """

    normal: float
    friction: float
    torque: float
    share: float
    slip: float
    spin: float


@dataclass(frozen=True)
class Contact:
    """A contact in both.

    Parameters
    ----------
    name : str
        As of the step; of MuJoCo its number and the geoms.
    bodies : tuple of str
        The two; ``"world"`` for what cannot move.
    depth : float
        By how much they penetrate [m].
    mu_v, mu_omega : float
        Friction [-] and torsional friction [m].
    pair : str
        What touches, as of all contacts of the two.
    theirs : Bearing
        The engine's.
    exact : Bearing or None
        None where joints or equalities bear any force.
    """

    name: str
    bodies: tuple[str, str]
    depth: float
    mu_v: float
    mu_omega: float
    pair: str
    theirs: Bearing
    exact: Bearing | None


@dataclass(frozen=True)
class Motion:
    """How a body moves.

    Parameters
    ----------
    speed : float
        Of its centre of mass [m/s].
    turn : float
        [rad/s].
    sinks : float
        Its speed along gravity [m/s].
    """

    speed: float
    turn: float
    sinks: float


@dataclass(frozen=True)
class Body:
    """A body that touches and can move, in both; with all that is welded to it.

    Parameters
    ----------
    name : str
    size : float
        Its farthest point from its centre of mass [m].
    rests : bool
        Whether it is slower than CREEP in the state itself, in the engine.
    steady : bool
        Whether the engine's motion of it stays as it is: its mean over a WINDOW, or its velocity,
        since contacts come and go.
    free : bool
        Whether nothing but its contacts holds it.
    needed : float
        The friction that balances loads and normal forces [N]; that of the exact answer where
        joints take part.
    bears : float
        The sum of mu_v f_n of its contacts [N].
    torque : float
        Moment that is not balanced, about the axis about which it turns [N m].
    balanced : bool
        Whether all forces of the engine's add up to none on it.
    theirs, exact : Motion
        In the exact answer, of one step from rest.
    """

    name: str
    size: float
    rests: bool
    steady: bool
    free: bool
    needed: float
    bears: float
    torque: float
    balanced: bool
    theirs: Motion
    exact: Motion

    def fastest(self, motion: Motion) -> float:
        """A bound on the speed of its points in one of its motions [m/s]."""
        return motion.speed + self.size * motion.turn


class Touch(NamedTuple):
    """A contact of an engine's: one point, or all points of two geometries.

    Parameters
    ----------
    name : str
    nearest : StateContact
        That, or the nearest of these points.
    of_step : tuple of str
        The step's contacts that it stands for, by their names.
    slides : tuple of StateContact
        Where the surfaces may slide on each other.
    wrench : ndarray, shape (4,)
        The engine's (f_d1, f_d2, f_n, tau_n), in the frame of the first of these [N, N m].
    """

    name: str
    nearest: StateContact
    of_step: tuple[str, ...]
    slides: tuple[StateContact, ...]
    wrench: Array

    @property
    def bodies(self) -> tuple[str, str]:
        """Alpha's and beta's; ``"world"`` for what cannot move."""
        return self.nearest.bodies


class Mover(NamedTuple):
    """A body that can move, with all that is welded to it.

    Parameters
    ----------
    name : str
    mass : float
        [kg].
    size : float
        Its farthest point from its centre of mass [m].
    free : bool
        Whether nothing but contacts holds it.
    linear, angular : ndarray, shape (3, nv)
        Jacobians of its centre of mass, world frame [-, m].
    """

    name: str
    mass: float
    size: float
    free: bool
    linear: Array
    angular: Array

    def fastest(self, v: Array) -> float:
        """A bound on the speed of its points [m/s] at a velocity v, (nv,)."""
        turn = np.linalg.norm(self.angular @ v)
        return float(np.linalg.norm(self.linear @ v) + self.size * turn)


@dataclass(frozen=True, eq=False)
class EngineState:
    """What an engine says of a state.

    Parameters
    ----------
    touches : tuple of Touch
    movers : tuple of Mover
    M : ndarray, shape (nv, nv)
        Mass matrix [kg, kg m, kg m^2].
    gravity : ndarray, shape (3,)
        [m/s^2].
    v, acceleration : ndarray, shape (nv,)
        Of the state itself [m/s, m/s^2; rad].
    mean, later : ndarray, shape (nv,)
        Its velocity over a WINDOW, and over the one after it [m/s, rad/s].
    """

    touches: tuple[Touch, ...]
    movers: tuple[Mover, ...]
    M: Array
    gravity: Array
    v: Array
    acceleration: Array
    mean: Array
    later: Array


@dataclass(frozen=True, eq=False)
class Compared:
    """A state in both.

    Parameters
    ----------
    state : EngineState
    answer : StepSolution
        The exact answer whose forces count.
    acceleration : ndarray, shape (nv,)
        Of that answer [m/s^2, rad/s^2].
    exact : ndarray, shape (nv,)
        The velocity of the exact step [m/s, rad/s].
    """

    state: EngineState
    answer: StepSolution
    acceleration: Array
    exact: Array

    @property
    def forces(self) -> Array:
        """(f_d1, f_d2, f_n, tau_n) of the exact answer's contacts, shape (n_c, 4) [N, N m]."""
        try:
            return self.answer.forces
        except QuasistaticError:  # where they are not unique to any digit: those of the proof
            return self.answer.wrench

    @cached_property
    def present(self) -> Array:
        """The engine's velocity, (nv,): of the state where that is steady, else the mean."""
        state = self.state
        names = {name for touch in state.touches for name in touch.bodies}
        movers = [mover for mover in state.movers if mover.name in names]
        steady = all(
            WINDOW * mover.fastest(state.acceleration)
            <= max(CREEP, STEADY * mover.fastest(state.v))
            for mover in movers
        )
        return state.v if steady else state.mean

    def contacts(self) -> Iterator[Contact]:
        """All contacts that the engine has."""
        number = {name: j for j, name in enumerate(self.answer.step.contacts.name)}
        for touch in self.state.touches:
            mine = [number[name] for name in touch.of_step if name in number]
            nearest = touch.nearest
            yield Contact(
                touch.name, touch.bodies, max(0.0, -nearest.phi), nearest.mu_v, nearest.mu_omega,
                nearest.pair,
                theirs=self._bearing(touch, touch.wrench[None], self.present),
                exact=self._together(touch, mine) if mine else None,
            )  # fmt: skip

    def bodies(self) -> Iterator[Body]:
        """All bodies that touch and can move."""
        of_step = {name: touch.bodies for touch in self.state.touches for name in touch.of_step}
        moved = {name for touch in self.state.touches for name in touch.bodies}
        contacts = self.answer.step.contacts
        rubs = np.einsum("jt,tjc->jc", self.forces[:, :2], np.array([contacts.d1, contacts.d2]))
        for mover in self.state.movers:
            if mover.name not in moved:
                continue
            friction = np.zeros(3)
            bears = 0.0
            for j, name in enumerate(contacts.name):
                if name in of_step and mover.name in of_step[name]:
                    friction += rubs[j] if of_step[name][1] == mover.name else -rubs[j]
                    bears += float(contacts.mu_v[j] * self.forces[j, 2])
            yield self._body(mover, friction, bears)

    def _body(self, mover: Mover, friction: Array, bears: float) -> Body:
        state, linear, angular = self.state, mover.linear, mover.angular
        # A free body's: mass times acceleration is the sum of loads, normal forces and friction.
        needed = mover.mass * linear @ self.acceleration - friction if mover.free else friction
        a = np.where((linear != 0).any(axis=0) | (angular != 0).any(axis=0), self.acceleration, 0)
        turn = float(np.linalg.norm(angular @ self.acceleration))

        fastest = mover.fastest(state.mean)
        changes = [state.later - state.mean, WINDOW * state.acceleration]
        return Body(
            name=mover.name,
            size=mover.size,
            rests=mover.fastest(state.v) <= CREEP,
            steady=min(map(mover.fastest, changes)) <= max(CREEP, STEADY * fastest),
            free=mover.free,
            needed=float(np.linalg.norm(needed)),
            bears=bears,
            # Of a rotation about a line, a'Ma is the moment of inertia times the rate squared.
            torque=float(a @ state.M @ a / turn) if mover.free and turn else 0.0,
            balanced=self._balanced(mover),
            theirs=self._motion(linear @ state.mean, angular @ state.mean),
            exact=self._motion(linear @ self.exact, angular @ self.exact),
        )

    def _balanced(self, mover: Mover) -> bool:
        """Whether what accelerates a body is no more than FORCES_AGREE of the forces on it."""
        state = self.state
        forces = [t.wrench[2] for t in state.touches if mover.name in t.bodies]
        weight = mover.mass * float(np.linalg.norm(state.gravity))
        left = mover.mass * float(np.linalg.norm(mover.linear @ state.acceleration))
        return left <= FORCES_AGREE * max(weight, float(np.abs(forces).sum()))

    def _motion(self, v: Array, omega: Array) -> Motion:
        down = self.state.gravity / (np.linalg.norm(self.state.gravity) or 1.0)
        return Motion(float(np.linalg.norm(v)), float(np.linalg.norm(omega)), float(v @ down))

    def _together(self, touch: Touch, mine: list[int]) -> Bearing:
        """What the step's contacts of these numbers bear together: friction is their resultant."""
        contacts = self.answer.step.contacts
        both = np.array([contacts.d1[mine], contacts.d2[mine]])
        rubs = np.einsum("jt,tjc->c", self.forces[mine][:, :2], both)
        each = self._bearing(touch, self.forces[mine], self.exact)
        return replace(each, friction=float(np.linalg.norm(rubs)))

    def _bearing(self, touch: Touch, wrenches: Array, v: Array) -> Bearing:
        """What contacts bear and how fast they move.

        Parameters
        ----------
        touch : Touch
        wrenches : ndarray, shape (k, 4)
            (f_d1, f_d2, f_n, tau_n) of each [N, N m].
        v : ndarray, shape (nv,)
            [m/s, rad/s].
        """
        f_n = wrenches[:, 2]
        nearest = touch.nearest
        mus = np.array([nearest.mu_v, nearest.mu_v, nearest.mu_omega])
        of_limits = np.abs(wrenches[:, [0, 1, 3]]) / np.where(mus > 0, mus, np.inf)
        pyramid = self.answer.cone == PYRAMID
        used = of_limits.sum(axis=1) if pyramid else np.linalg.norm(of_limits, axis=1)
        normal = float(f_n.sum())
        return Bearing(
            normal=normal,
            friction=float(np.hypot(*wrenches[:, :2].sum(axis=0))),
            torque=float(abs(wrenches[:, 3].sum())),
            share=float(used.sum() / normal) if normal > 0 else 0.0,
            slip=max(contact.slip(v) for contact in touch.slides),
            spin=max(contact.spin(v) for contact in touch.slides),
        )
