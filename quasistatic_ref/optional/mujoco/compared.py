"""Contacts and bodies of a state: what MuJoCo says of them next to the exact answer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.mujoco.tolerances import FORCES_AGREE, STEADY
from quasistatic_ref.optional.mujoco.touches import StateContact
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.step.solution import StepSolution
from quasistatic_ref.tolerances import CREEP

ALIKE = 1e-6
"""Sine between tangent planes of a body's contacts up to which they count as one [-]."""
WINDOW = 0.1
"""Time over which MuJoCo's motion is measured [s]: many of its time steps, and few of a fall."""


@dataclass(frozen=True)
class Bearing:
    """The force of a contact, and the motion of its surfaces.

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
    """A contact of a state, in MuJoCo and in the exact answer.

    Parameters
    ----------
    name : str
        MuJoCo's number and the geoms, as of the step.
    bodies : tuple of str
        The two; ``"world"`` for what cannot move.
    depth : float
        By how much they penetrate [m].
    mu_v, mu_omega : float
        Friction [-] and torsional friction [m].
    pair : str
        What touches, as of all contacts of the two.
    theirs : Bearing
        MuJoCo's.
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
    """How fast a body moves, turns and sinks.

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
    """A body that moves and touches in both engines, with all bodies welded to it.

    Parameters
    ----------
    name : str
    size : float
        Its farthest point from its centre of mass [m].
    rests : bool
        Whether it is slower than CREEP in the state itself, in MuJoCo.
    steady : bool
        Whether MuJoCo's motion of it stays as it is: its mean over a WINDOW, or its velocity,
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
    rolling : float
        The sum of the moments of MuJoCo's rolling friction at its contacts [N m].
    balanced : bool
        Whether all of MuJoCo's forces add up to none on it.
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
    rolling: float
    balanced: bool
    theirs: Motion
    exact: Motion

    def fastest(self, motion: Motion) -> float:
        """A bound on the speed of its points in one of its motions [m/s]."""
        return motion.speed + self.size * motion.turn


class Mover(NamedTuple):
    """A body that can move, with all bodies welded to it.

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
class MujocoAnswer:
    """MuJoCo's forces and motions in a state.

    Parameters
    ----------
    contacts : tuple of StateContact, length n_c
    wrenches : ndarray, shape (n_c, 6)
        (f_d1, f_d2, f_n, tau_n, tau_d1, tau_d2) of each, in its frame [N, N m].
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

    contacts: tuple[StateContact, ...]
    wrenches: Array
    movers: tuple[Mover, ...]
    M: Array
    gravity: Array
    v: Array
    acceleration: Array
    mean: Array
    later: Array


@dataclass(frozen=True, eq=False)
class Compared:
    """A MuJoCo state compared with the exact answer.

    Parameters
    ----------
    theirs : MujocoAnswer
    answer : StepSolution
        The exact answer whose forces count.
    acceleration : ndarray, shape (nv,)
        Of that answer [m/s^2, rad/s^2].
    exact : ndarray, shape (nv,)
        The velocity of the exact step [m/s, rad/s].
    """

    theirs: MujocoAnswer
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
        """MuJoCo's velocity, (nv,): of the state where that is steady, else the mean."""
        theirs = self.theirs
        names = {name for contact in theirs.contacts for name in contact.bodies}
        movers = [mover for mover in theirs.movers if mover.name in names]
        steady = all(
            WINDOW * mover.fastest(theirs.acceleration)
            <= max(CREEP, STEADY * mover.fastest(theirs.v))
            for mover in movers
        )
        return theirs.v if steady else theirs.mean

    def contacts(self) -> Iterator[Contact]:
        """All contacts that MuJoCo has."""
        number = {name: j for j, name in enumerate(self.answer.step.contacts.name)}
        for contact, wrench in zip(self.theirs.contacts, self.theirs.wrenches, strict=True):
            j = number.get(contact.name)
            yield Contact(
                contact.name, contact.bodies, max(0.0, -contact.distance), contact.mu_v,
                contact.mu_omega, contact.pair,
                theirs=self._bearing(contact, wrench[:4], self.present),
                exact=None if j is None else self._bearing(contact, self.forces[j], self.exact),
            )  # fmt: skip

    def bodies(self) -> Iterator[Body]:
        """All bodies that touch and can move."""
        touching = {contact.name: contact.bodies for contact in self.theirs.contacts}
        names = {name for bodies in touching.values() for name in bodies}
        contacts = self.answer.step.contacts
        rubs = np.einsum("jt,tjc->jc", self.forces[:, :2], np.array([contacts.d1, contacts.d2]))
        for mover in self.theirs.movers:
            if mover.name not in names:
                continue
            friction = np.zeros(3)
            bears = 0.0
            on = []
            for j, name in enumerate(contacts.name):
                alpha, beta = touching[name]
                if mover.name in (alpha, beta):
                    on.append(j)
                    friction += rubs[j] if mover.name == beta else -rubs[j]
                    bears += float(contacts.mu_v[j] * self.forces[j, 2])
            tangents = np.concatenate([contacts.d1[on], contacts.d2[on]])
            yield self._body(mover, friction, bears, tangents)

    def _body(self, mover: Mover, friction: Array, bears: float, tangents: Array) -> Body:
        theirs = self.theirs
        linear = mover.linear
        angular = mover.angular
        # A free body's: mass times acceleration is the sum of loads, normal forces and friction.
        needed = mover.mass * linear @ self.acceleration - friction if mover.free else friction
        # What is left along normals of one direction, as of what topples, no friction balances.
        needed = np.linalg.pinv(tangents, ALIKE) @ (tangents @ needed)
        a = np.where((linear != 0).any(axis=0) | (angular != 0).any(axis=0), self.acceleration, 0)
        turn = float(np.linalg.norm(angular @ self.acceleration))
        fastest = mover.fastest(theirs.mean)
        changes = [theirs.later - theirs.mean, WINDOW * theirs.acceleration]
        return Body(
            name=mover.name,
            size=mover.size,
            rests=mover.fastest(theirs.v) <= CREEP,
            steady=min(map(mover.fastest, changes)) <= max(CREEP, STEADY * fastest),
            free=mover.free,
            needed=float(np.linalg.norm(needed)),
            bears=bears,
            # Of a rotation about a line, a'Ma is the moment of inertia times the rate squared.
            torque=float(a @ theirs.M @ a / turn) if mover.free and turn else 0.0,
            rolling=self._rolling(mover),
            balanced=self._balanced(mover),
            theirs=self._motion(linear @ theirs.mean, angular @ theirs.mean),
            exact=self._motion(linear @ self.exact, angular @ self.exact),
        )

    def _rolling(self, mover: Mover) -> float:
        """The sum of the moments of MuJoCo's rolling friction at a body's contacts [N m]."""
        touching = [mover.name in contact.bodies for contact in self.theirs.contacts]
        return float(np.linalg.norm(self.theirs.wrenches[touching, 4:], axis=1).sum())

    def _balanced(self, mover: Mover) -> bool:
        """Whether the net force on a body is at most FORCES_AGREE of the forces on it."""
        theirs = self.theirs
        touching = [mover.name in contact.bodies for contact in theirs.contacts]
        forces = theirs.wrenches[touching, 2]
        weight = mover.mass * float(np.linalg.norm(theirs.gravity))
        left = mover.mass * float(np.linalg.norm(mover.linear @ theirs.acceleration))
        return left <= FORCES_AGREE * max(weight, float(np.abs(forces).sum()))

    def _motion(self, v: Array, omega: Array) -> Motion:
        down = self.theirs.gravity / (np.linalg.norm(self.theirs.gravity) or 1.0)
        return Motion(float(np.linalg.norm(v)), float(np.linalg.norm(omega)), float(v @ down))

    def _bearing(self, contact: StateContact, wrench: Array, v: Array) -> Bearing:
        """The force of a contact and its slip and spin rates, as one :class:`Bearing`.

        Parameters
        ----------
        contact : StateContact
        wrench : ndarray, shape (4,)
            (f_d1, f_d2, f_n, tau_n) [N, N m].
        v : ndarray, shape (nv,)
            [m/s, rad/s].
        """
        f_d1, f_d2, f_n, tau_n = wrench.tolist()
        mus = np.array([contact.mu_v, contact.mu_v, contact.mu_omega])
        of_limits = np.abs([f_d1, f_d2, tau_n]) / np.where(mus > 0, mus, np.inf)
        pyramid = self.answer.cone == PYRAMID
        used = of_limits.sum() if pyramid else np.linalg.norm(of_limits)
        return Bearing(
            normal=f_n,
            friction=float(np.hypot(f_d1, f_d2)),
            torque=abs(tau_n),
            share=float(used / f_n) if f_n > 0 else 0.0,
            slip=contact.slip(v),
            spin=contact.spin(v),
        )
