r"""A step of one group by Coulomb's law, at any time step T in the place of h.

By Coulomb's law nothing rises: phi + s takes the place of phi, s being the norm of a contact's own
slip. With T >> h the drag of a motion that is asked for, d, is M_u d / T^2, and vanishes. What is
left, r = -M_u delta_q_u / T^2, is what no forces of Coulomb's law bear.

Answers are those of floats. What decides is the residual of s: only an s that is its own slip's
norm is a fixed point. T climbs by factors of three, so that s starts near its own: what slides
freely goes with T^2.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.numbers.arrays import Array, Mask, read_only, without_warnings
from quasistatic_ref.optional.doctor.artifacts import quotient
from quasistatic_ref.optional.fixed_point import Iterate, fixed_point
from quasistatic_ref.optional.friction import slip_norm
from quasistatic_ref.parts import is_there
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.solve.units import ScaledStep, in_si
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.friction import contact_wrenches
from quasistatic_ref.step.standard_form import Units, frame_jacobian
from quasistatic_ref.tolerances import ACCURACY

SLOWLY = 10.0
"""T [s], or a thousand h if that is more: what nothing bears falls by 500 m."""
STRAIGHT = 0.1
"""Motion of a contact over the smaller shape [-], or turn [rad], of a straight step."""
FIRST = 0.01
"""Part of the smallest shape [-] that falls in the first T of a climb."""
FALLS = 9.81
"""Acceleration with which it does [m/s^2]: that of the earth, whatever a scene's is."""
OWN = {True: (1e-8, 1e-10), False: (1e-6, 1e-9)}
"""Residual of an s that is its own: over the longest motion of a contact [-], or [m] if that is
more; in a polyhedral cone, and in a round one."""
MOST = 40
"""Iterates after which no fixed point is expected at a T."""
FEW = 16
"""The same at the last T, where no smaller T has led."""
CUTS = 20
"""Rounds of tangents to a round cone, at most."""
ROUND = 1e-8
"""Part of the longest motion of a contact that tangents may leave of its slip [-]."""


class Rung(NamedTuple):
    """The step by Coulomb's law at one T.

    Parameters
    ----------
    T : float
        [s]
    delta_q : ndarray, shape (n_v,)
    forces : ndarray, shape (n_c, 4)
        Along d1, d2 and n, and about n [N, N m].
    s : ndarray, shape (n_c,)
        [m]
    moves : float
        The longest motion over what is straight [-].
    """

    T: float
    delta_q: Array
    forces: Array
    s: Array
    moves: float


class Slow:
    """A step of one group at any T.

    Parameters
    ----------
    step : StepData
    sizes : ndarray, shape (n_c,)
        Of the smaller shapes of its contacts [m].
    turns : ndarray of bool, shape (n_v,)
        Un-actuated coordinates that are angles.
    """

    def __init__(self, step: StepData, sizes: Array, turns: Mask) -> None:
        contacts = step.contacts
        self.step = step
        self.sizes = sizes
        self.turns = turns
        self.end = max(SLOWLY, 1000 * step.h)
        self.polyhedral = cone(step.cone).polyhedral
        self.level = np.zeros_like(sizes)
        self._J_n, *J_t = frame_jacobian(contacts, contacts.J)
        self._slips = contacts.mu[:, :, None] * np.stack(J_t, axis=1)
        self._reach = np.abs(self._slips)
        self._solver: Solver | None = None
        of, axis = np.nonzero(contacts.mu > 0)
        self._axes = 2 * len(of)
        u = np.eye(3)[axis]
        self._tangents = np.concatenate([of, of]), np.concatenate([u, -u])

    def convex(self, T: float, s: Array) -> tuple[Array, Array]:
        """delta_q, (n_v,), and forces, (n_c, 4) [N, N m], of the convex step at T [s] with phi + s.

        QuasistaticError if there is none.
        """
        contacts = self.step.contacts
        raised = contacts.with_fields(phi=read_only(contacts.phi + s))
        step = self.step.with_fields(h=T, contacts=raised)
        scaled = ScaledStep(step)
        if not self.polyhedral:
            return self._round(step, scaled.units)
        delta_q, lam = self._floats(scaled)
        of_contacts = lam[: step.offsets[-1]]
        return delta_q, contact_wrenches(step.contacts, of_contacts, T, step.cone)

    def _floats(self, scaled: ScaledStep) -> tuple[Array, Array]:
        """delta_q, (n_v,), and lam, (m,), of a step in some units, by a backend's word alone."""
        step = scaled.step
        if self._solver is None or not self._solver.fits(step):
            self._solver = solver_for(step, fast=is_there("fast"))
        reply = self._solver.answer(scaled, ACCURACY)
        if not reply.solved:
            raise StepNotSolved(self._solver.name, reply.status, step, reply.accuracy)
        return in_si(*reply.answer, scaled.units)

    def _round(self, step: StepData, units: Units) -> tuple[Array, Array]:
        """The optimum in the ellipsoid, whose rows are tangents where contacts slip.

        Each has a contact, `at`, and a direction u: gap >= u . (mu_v slip_1, mu_v slip_2, mu_omega
        spin). Those along the axes stay, others while they press. Units of the step serve all.
        """
        contacts = step.contacts
        extra = step.extra
        at, u = self._tangents
        for _ in range(CUTS):
            rows = self._J_n[at] - np.einsum("ri,riv->rv", u, self._slips[at])
            tangents = extra.with_fields(
                names=(*extra.names, *("tangent",) * len(at)),
                A=np.vstack([extra.A, rows]),
                b=np.concatenate([extra.b, -contacts.phi[at]]),
            )
            cut = step.with_fields(cone="frictionless", extra=tangents)
            delta_q, lam = self._floats(ScaledStep(cut, units))
            slip = self._slips @ delta_q
            norm = np.linalg.norm(slip, axis=1)
            beyond = norm - (contacts.phi + self._J_n @ delta_q)
            pushes = lam[contacts.n_c + len(extra.names) :] / step.h
            forces = np.zeros((contacts.n_c, 4))
            forces[:, 2] = lam[: contacts.n_c] / step.h
            np.add.at(forces, at, pushes[:, None] * np.insert(-u, 2, 1.0, axis=1))
            forces[:, [0, 1, 3]] *= contacts.mu
            new = np.flatnonzero((norm > 0) & (beyond > ROUND * self._longest(delta_q)))
            kept = (pushes > 0) | (np.arange(len(at)) < self._axes)
            at = np.concatenate([at[kept], new])
            u = np.vstack([u[kept], slip[new] / norm[new, None]])
            if not new.size:
                break
        self._tangents = at, u
        return delta_q, forces

    def _longest(self, delta_q: Array) -> float:
        """The sum of the sizes of a contact's motions, at the largest contact [m]."""
        return float((self._reach @ np.abs(delta_q)).sum(axis=1).max(initial=0.0))

    def rung(self, T: float, start: Array, most: int = MOST) -> Rung | None:
        """The step by Coulomb's law at T [s], from s = start, (n_c,) [m]; None if none is found."""
        of_way, least = OWN[self.polyhedral]

        def at(s: Array) -> Iterate[tuple[Array, Array]]:
            delta_q, forces = self.convex(T, s)
            slip = slip_norm(self._slips @ delta_q, self.step.cone)
            residual = float(np.abs(slip - s).max(initial=0.0))
            own = residual <= max(of_way * self._longest(delta_q), least)
            return Iterate(s, slip, residual, bool(own), (delta_q, forces))

        try:
            last, _ = without_warnings(fixed_point, at, start, most, True)
        except StepNotSolved:
            return None
        if not last.converged:
            return None
        delta_q, forces = last.of
        ways = np.linalg.norm(self.step.contacts.motion(delta_q)[:, :3], axis=1) / self.sizes
        far = max(ways.max(initial=0.0), np.abs(delta_q[self.turns]).max(initial=0.0))
        return Rung(T, delta_q, forces, last.image, float(far) / STRAIGHT)

    @cached_property
    def last(self) -> Rung | None:
        """The answer at the last T, from s = 0; None if none is found."""
        return self.rung(self.end, self.level, FEW)

    @cached_property
    def climbed(self) -> list[Rung]:
        """Each T that has an answer, on the way to the last.

        Where smaller T lead to none at the last, s = 0 may.
        """
        T = float(np.sqrt(FIRST * self.sizes.min(initial=1.0) / FALLS))
        kept: list[Rung] = []
        while True:
            one = self.rung(T, _ahead(kept, T) if kept else self.level)
            if one is None and self.end <= T:
                one = self.rung(T, self.level)
            kept += [] if one is None else [one]
            if self.end <= T:
                return kept
            T = min(3 * T, self.end)


def _ahead(kept: list[Rung], T: float) -> Array:
    """Where the last two s lead at T [s]: at most as far as what slides freely."""
    last = kept[-1]
    if len(kept) == 1:
        return last.s
    grows = quotient(last.s, kept[-2].s, 1.0)
    return np.asarray(last.s * grows.clip(0.0, (T / last.T) ** 2))
