"""Contacts and bodies of a MuJoCo state: what MuJoCo says of them next to the exact answer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.optional.guests import touches
from quasistatic_ref.optional.guests.fates import kind_of
from quasistatic_ref.optional.guests.still import Still
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.tolerances import CREEP, STEADY

WINDOW = 0.1
"""Time over which MuJoCo's motion is measured [s]: many of its time steps, and few of a fall."""


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
        MuJoCo's number and the geoms.
    bodies : tuple of str
        The two; ``"world"`` for what cannot move.
    depth : float
        By how much they penetrate [m].
    mu_v, mu_omega : float
        Friction [-] and torsional friction [m].
    mujoco : Bearing
    exact : Bearing or None
        None where joints or equalities bear any force.
    """

    name: str
    bodies: tuple[str, str]
    depth: float
    mu_v: float
    mu_omega: float
    mujoco: Bearing
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
        Whether it is slower than CREEP in the state itself, in MuJoCo.
    steady : bool
        Whether MuJoCo's motion of it stays as it is: its mean over a WINDOW, or its velocity, since
        contacts come and go.
    free : bool
        Whether nothing but its contacts holds it.
    asked : float
        The friction that balances loads and normal forces [N]; that of the exact answer where
        joints take part.
    bears : float
        The sum of mu_v f_n of its contacts [N].
    torque : float
        Moment that is not balanced, about the axis about which it turns [N m].
    mujoco, exact : Motion
        In the exact answer, of one step from rest.
    """

    name: str
    size: float
    rests: bool
    steady: bool
    free: bool
    asked: float
    bears: float
    torque: float
    mujoco: Motion
    exact: Motion

    def fastest(self, motion: Motion) -> float:
        """A bound on the speed of its points in one of its motions [m/s]."""
        return motion.speed + self.size * motion.turn


@dataclass(frozen=True, eq=False)
class Compared:
    """A state in both.

    Parameters
    ----------
    state : Still
    data : mujoco.MjData
        The state itself, with its velocity, after ``mj_forward``.
    answer : StepSolution
        The exact answer whose forces count.
    acceleration : ndarray, shape (nv,)
        Of that answer [m/s^2, rad/s^2].
    mean, later : ndarray, shape (nv,)
        MuJoCo's velocity over a while, and over the while after it [m/s, rad/s].
    exact : ndarray, shape (nv,)
        That of the exact step [m/s, rad/s].
    """

    state: Still
    data: Any
    answer: StepSolution
    acceleration: Array
    mean: Array
    later: Array
    exact: Array

    @property
    def forces(self) -> Array:
        """(f_d1, f_d2, f_n, tau_n) of the exact answer's contacts, shape (n_c, 4) [N, N m]."""
        try:
            return self.answer.forces
        except QuasistaticError:  # where they are not unique to any digit: those of the proof
            return self.answer.wrench

    def contacts(self) -> Iterator[Contact]:
        """All contacts that MuJoCo has."""
        state = self.state
        exact = dict(zip(self.answer.step.contacts.name, self.forces, strict=True))
        theirs = touches.forces(state, self.data)
        for name, touch in touches.found(state):
            J = touches.jacobian(state, touch)
            mine = exact.get(name)
            yield Contact(
                name=name,
                bodies=(self.body(touch.geom[0]), self.body(touch.geom[1])),
                depth=-touches.gap(touch),
                mu_v=float(touch.friction[0]) if touch.dim > 1 else 0.0,
                mu_omega=float(touch.friction[2]) if touch.dim > 3 else 0.0,
                mujoco=self._bearing(touch, theirs[touches.number(name)], J @ self.mean),
                exact=None if mine is None else self._bearing(touch, mine, J @ self.exact),
            )

    def body(self, geom: int) -> str:
        """The name of the body that a geom moves with."""
        number = self.state.model.body_weldid[self.state.model.geom_bodyid[geom]]
        return self.state.called("body", number) if number else "world"

    def bodies(self) -> Iterator[Body]:
        """All bodies that touch and can move."""
        state = self.state
        found = touches.found(state)
        weld = state.model.body_weldid
        moved = {int(weld[state.model.geom_bodyid[g]]) for _, touch in found for g in touch.geom}
        contacts = self.answer.step.contacts
        for b in sorted(moved - {0}):
            friction = np.zeros(3)
            bears = 0.0
            for name, mu_v, wrench in zip(contacts.name, contacts.mu_v, self.forces, strict=True):
                touch = state.data.contact[touches.number(name)]
                on = weld[state.model.geom_bodyid[touch.geom]] == b
                if on.any():
                    side = 1.0 if on[1] else -1.0
                    friction += side * wrench[:2] @ touch.frame[3:].reshape(2, 3)
                    bears += float(mu_v * wrench[2])
            yield self._body(b, friction, bears)

    def _body(self, b: int, friction: Array, bears: float) -> Body:
        state = self.state
        model = state.model
        own = np.flatnonzero(model.body_weldid == b)
        geoms = np.flatnonzero(np.isin(model.geom_bodyid, own))
        mass = float(model.body_mass[own].sum())
        centre = model.body_mass[own] @ state.data.xipos[own] / mass if mass else state.data.xpos[b]
        linear = np.zeros((3, model.nv))
        angular = np.zeros((3, model.nv))
        state.mujoco.mj_jac(model, state.data, linear, angular, centre, b)
        free = (
            kind_of(state, "jnt_type", model.body_jntadr[b]) == "FREE"
            and len(own) == np.isin(model.body_rootid, b).sum()
        )
        # A free body's: mass times acceleration is the sum of loads, normal forces and friction.
        asked = mass * linear @ self.acceleration - friction if free else friction
        own_motion = np.where(
            (linear != 0).any(axis=0) | (angular != 0).any(axis=0), self.acceleration, 0
        )
        turn = float(np.linalg.norm(angular @ self.acceleration))

        def fastest(v: Array) -> float:
            """A bound on the speed of its points [m/s]."""
            return float(np.linalg.norm(linear @ v) + size * np.linalg.norm(angular @ v))

        far = np.linalg.norm(state.data.geom_xpos[geoms] - centre, axis=1)
        size = float((far + model.geom_rbound[geoms]).max(initial=0.0))
        changes = [self.later - self.mean, WINDOW * self.data.qacc]
        return Body(
            name=state.called("body", b),
            size=size,
            rests=fastest(self.data.qvel) <= CREEP,
            steady=min(map(fastest, changes)) <= max(CREEP, STEADY * fastest(self.mean)),
            free=bool(free),
            asked=float(np.linalg.norm(asked)),
            bears=bears,
            # Of a rotation about a line, a'Ma is the moment of inertia times the rate squared.
            torque=float(own_motion @ state.M @ own_motion / turn) if free and turn else 0.0,
            mujoco=self._motion(linear @ self.mean, angular @ self.mean),
            exact=self._motion(linear @ self.exact, angular @ self.exact),
        )

    def _motion(self, v: Array, omega: Array) -> Motion:
        gravity = self.state.model.opt.gravity
        down = gravity / (np.linalg.norm(gravity) or 1.0)
        return Motion(float(np.linalg.norm(v)), float(np.linalg.norm(omega)), float(v @ down))

    def _bearing(self, touch: Any, wrench: Array, moves: Array) -> Bearing:
        """What a contact bears and how it moves, from (f_d1, f_d2, f_n, tau_n) and J v, (4,)."""
        f_n = float(wrench[2])
        of_limits = [
            abs(f) / mu if (mu := touch.friction[k]) and touch.dim > at else 0.0
            for k, at, f in ((0, 1, wrench[0]), (0, 1, wrench[1]), (2, 3, wrench[3]))
        ]
        pyramid = self.answer.cone == PYRAMID
        used = sum(of_limits) if pyramid else np.linalg.norm(of_limits)
        return Bearing(
            normal=f_n,
            friction=float(np.hypot(*wrench[:2])),
            torque=float(abs(wrench[3])),
            share=float(used / f_n) if f_n > 0 else 0.0,
            slip=float(np.linalg.norm(touch.frame[3:].reshape(2, 3) @ moves[:3])),
            spin=float(abs(moves[3])),
        )
