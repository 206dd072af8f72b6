"""Documented steps of a run, solved again with one thing changed.

What an artifact of the model changes is seen where a step is solved again from the same state, with
the run's own contacts, cone and loads but for one thing. The answers are not proved.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.doctor.artifacts import pressing
from quasistatic_ref.optional.doctor.equilibrium import statics
from quasistatic_ref.optional.doctor.start import SHORT, least, slices
from quasistatic_ref.parts import contact_forces, is_there
from quasistatic_ref.step.cones import ELLIPSOID, cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.friction import slip_norms

if TYPE_CHECKING:
    from quasistatic_ref.certify.contact_forces import ContactForces
    from quasistatic_ref.contact.pairs import ContactPair
    from quasistatic_ref.optional.doctor.run import Run
    from quasistatic_ref.step.contacts import Contacts

SLOWER = 16.0
"""By what M_u is divided, and with it the drag [-]."""
ITERATES = 20
"""Convex steps in which Coulomb's law is looked for."""
SETTLED = 0.01
"""Change of rises and of normal forces, over the largest, at which Coulomb's law holds [-]."""
WITHIN = 0.95
"""Friction over mu_v f_n [-] below which a contact that slips does so inside of the circle."""


@dataclass(frozen=True, eq=False)
class PairMotion:
    """What the contacts of one pair do in one answer to a step.

    Parameters
    ----------
    normal : float
        Sum of their normal forces [N].
    slip : ndarray, shape (n, 2)
        Their motion along d1 and d2 [m], zero where they do not press.
    spin : float
        Their largest turn about n where they press [rad].
    """

    normal: float
    slip: Array
    spin: float

    @property
    def way(self) -> float:
        """Longest slip [m]."""
        return float(np.linalg.norm(self.slip, axis=1).max(initial=0.0))


class Missing(NamedTuple):
    """What a body lacks for equilibrium in a step.

    Parameters
    ----------
    amount : float
        All of it, torques as forces at the radius of gyration [N].
    force, torque : float
        [N] and, about the centre of mass, [N m].
    k : int
        The step.
    """

    amount: float
    force: float
    torque: float
    k: int

    def __str__(self) -> str:
        if self.torque and self.amount > 2 * self.force:
            return f"{self.torque:.2g} N m"
        return f"{self.amount:.2g} N"


class RunStep:
    """A step of a run, and what it would be with one thing changed.

    Parameters
    ----------
    run : Run
    k : int
        Of the step.
    """

    def __init__(self, run: Run, k: int) -> None:
        self.run = run
        self.k = k

    @cached_property
    def contacts(self) -> Contacts:
        """Its contacts."""
        kinematics = self.run.system.kinematics(self.run["q"][self.k])
        return self.run.simulator.geometry.contacts(self.run.points_of(self.k), kinematics)

    @cached_property
    def step(self) -> StepData:
        """Its problem, up to rounding."""
        run = self.run
        k = self.k
        load = run.noted("tau")[k]
        return run.simulator.step_under(run["q"][k], run["q_bar_a"][k], load, self.contacts)

    @cached_property
    def compliant(self) -> ContactForces | None:
        """The forces of single contacts in a polyhedral cone, where they are rational.

        None if the run is not `searched`, or there is no optional/forces.
        """
        polyhedral = cone(self.run.simulator.cone).polyhedral
        if not (self.run.searched and polyhedral and is_there("forces")):
            return None
        near = self.run["delta_q"][self.k], self.run["wrench"][self.k]
        return contact_forces(self.step, near)

    @property
    def forces(self) -> Array:
        """Forces of single contacts, shape (n_c, 4) [N, N m].

        Where they cannot be formed, what the multipliers of the step combine to.
        """
        compliant = self.compliant
        return np.asarray(self.run["wrench"][self.k]) if compliant is None else compliant.wrench

    @cached_property
    def as_it_is(self) -> list[PairMotion]:
        """Of each pair, what it does in the run."""
        return self._pairs(self.run["delta_q"][self.k], self.forces)

    @cached_property
    def without_drag(self) -> list[PairMotion] | None:
        """The same with M_u / 16; None where it is not solved."""
        return self._answered(self.run.solved(self.step.replace(M_u=self.step.M_u / SLOWER)))

    @cached_property
    def by_coulomb(self) -> list[PairMotion] | None:
        """The same by Coulomb's law, to 1 %; None where no fixed point is reached."""
        return self._answered(self._coulomb())

    def _coulomb(self) -> StepSolution | None:
        """The step by Coulomb's law: the convex step whose contacts are raised by their slips."""
        contacts = self.step.contacts
        rise = np.zeros(contacts.n_c)
        last = np.inf
        for _ in range(ITERATES):
            answer = self.run.solved(self.step.replace(contacts=contacts.raised(rise)))
            if answer is None:
                return None
            slips = slip_norms(contacts, answer.delta_q, self.step.cone)
            normal = float(answer.wrench[:, 2].sum())
            off = np.abs(slips - rise).max(initial=0.0)
            if off <= SETTLED * slips.max(initial=0.0) and abs(normal - last) <= SETTLED * normal:
                return answer
            rise = slips
            last = normal
        return None

    @cached_property
    def in_ellipsoid(self) -> list[PairMotion] | None:
        """The same in the ellipsoid; None where it is not solved."""
        return None if self._rounder is None else self._answered(self.run.solved(self._rounder))

    @property
    def slips_inside(self) -> bool:
        """Whether a contact of a polyhedral cone slips with less friction than the circle has."""
        if not cone(self.step.cone).polyhedral:
            return False
        contacts = self.step.contacts
        friction = np.linalg.norm(self.forces[:, :2], axis=1)
        inside = friction < WITHIN * contacts.mu_v * self.forces[:, 2]
        slip = self._slips(contacts.motion(self.run["delta_q"][self.k]))
        slips = np.linalg.norm(slip, axis=1) > SHORT * self.run.sizes
        return bool((pressing(self.forces[:, 2]) & inside & slips).any())

    @property
    def unbalanced(self) -> dict[str, Missing]:
        """Free bodies that touch something and are not in equilibrium, and what is missing."""
        return {name: lacks for name, lacks in self.moved.items() if name in self._touched}

    @cached_property
    def moved(self) -> dict[str, Missing]:
        """Free bodies that are not in equilibrium, those among them that touch nothing."""
        return self._unbalanced(self.step)

    @cached_property
    def unbalanced_in_ellipsoid(self) -> dict[str, Missing]:
        """As `unbalanced`, in the ellipsoid."""
        return self.unbalanced if self._rounder is None else self._unbalanced(self._rounder)

    @cached_property
    def _rounder(self) -> StepData | None:
        """The step in the ellipsoid; None without ``optional/ellipsoid``."""
        try:
            return self.step.replace(cone=ELLIPSOID)
        except QuasistaticError:
            return None

    def _unbalanced(self, step: StepData) -> dict[str, Missing]:
        run = self.run
        actuated = step.contacts.J[:, :, : step.n_a].any(axis=(1, 2))
        at_most = np.where(actuated, np.maximum(self.forces[:, 2], 0.0), np.inf)
        missing = statics(step, self._touching, at_most, run.masses, run.translations).missing
        unbalanced = {}
        for name in run.free_bases:
            coordinates = np.flatnonzero([owner == name for owner in run.owners])
            amount = float(np.linalg.norm(missing[coordinates]))
            if amount > run.light:
                force, turn = np.split(missing[coordinates], [3])
                gyration = np.linalg.cholesky(step.M_u[np.ix_(coordinates, coordinates)])[3:, 3:]
                torque = gyration @ turn / np.sqrt(run.system.mass(name))
                lengths = float(np.linalg.norm(force)), float(np.linalg.norm(torque))
                unbalanced[name] = Missing(amount, *lengths, self.k)
        return unbalanced

    @cached_property
    def _touching(self) -> Mask:
        return self.run.touching(self.step.contacts) | pressing(self.forces[:, 2])

    @cached_property
    def _touched(self) -> set[str]:
        """Free bodies that something touches."""
        return {x for x in self.run.free_bases if (self._touching & self.run.of_body(x)).any()}

    @cached_property
    def floats(self) -> float:
        """The largest gap [m] of a contact that presses, on a layer of the steps before.

        By Coulomb's law there is none: a body comes down by as much, which is no motion of its own.
        """
        presses = pressing(self.forces[:, 2])
        return float(self.step.contacts.phi.max(where=presses, initial=0.0))

    def comes_down(self, pair: ContactPair) -> float:
        """A force [N] that comes of a free body's coming down from its layer in one step.

        It moves the body, and friction of its other contacts may turn round.
        """
        if self.floats <= SHORT * least(pair):
            return 0.0
        run = self.run
        free = run.bodies(pair) & run.free_bases.keys()
        mass = sum(run.system.mass(name) for name in free)
        rubs = sum(
            other.mu_v * does.normal
            for other, does in zip(run.pairs, self.as_it_is, strict=True)
            if other is not pair and run.bodies(other) & free
        )
        return mass * self.floats / run.h**2 + 2 * rubs

    def _answered(self, answer: StepSolution | None) -> list[PairMotion] | None:
        """What an answer says, by the forces of single contacts, which are unique."""
        if answer is None:
            return None
        forces = answer.wrench
        if cone(answer.step.cone).polyhedral:
            with suppress(QuasistaticError):
                forces = answer.forces
        return self._pairs(answer.delta_q, forces)

    def _pairs(self, delta_q: Array, forces: Array) -> list[PairMotion]:
        motion = self.step.contacts.motion(delta_q)
        presses = pressing(forces[:, 2])
        slip = np.where(presses[:, None], self._slips(motion), 0.0)
        spin = np.where(presses, np.abs(motion[:, 3]), 0.0)
        return [
            PairMotion(float(forces[i, 2].sum()), slip[i], float(spin[i].max(initial=0.0)))
            for _, i in slices(self.run.pairs)
        ]

    def _slips(self, motion: Array) -> Array:
        """The part of motions along d1 and d2, shape (n_c, 2) [m]."""
        tangents = np.stack([self.step.contacts.d1, self.step.contacts.d2], axis=1)
        return np.asarray(np.vecdot(motion[:, None, :3], tangents))


def documented_steps(run: Run) -> list[int]:
    """Three steps of a run: that of the largest motion, the last, and one where contacts change.

    The largest motion is that of a body that something touches, in the square root of its kinetic
    energy, or, where all is actuated, of a contact that presses. Of changes of which pairs press
    that is taken under the largest forces.
    """
    normal = run["wrench"][:, :, 2]
    presses = pressing(normal)
    motion = np.zeros(run.steps)
    moved = run["delta_q"][:, run.system.n_a :] * np.sqrt(np.diag(run.system.M_u(run.q_start)))
    for name in dict.fromkeys(run.owners):
        touched = presses[:, run.of_body(name)].any(axis=1)
        of_body = moved[:, [owner == name for owner in run.owners]]
        motion = np.maximum(motion, np.where(touched, np.linalg.norm(of_body, axis=1), 0.0))
    if not motion.any():
        length = np.linalg.norm(run.noted("moved")[:, :, :3], axis=2)
        motion = np.where(presses, length, 0.0).max(axis=1, initial=0.0)
    of_pairs = [presses[:, of_pair].any(axis=1) for _, of_pair in slices(run.pairs)]
    changes = np.any([np.diff(pair) for pair in of_pairs], axis=0)
    chosen = {int(motion.argmax()), run.steps - 1}
    if changes.any():
        chosen.add(int(np.where(changes, normal[1:].sum(axis=1), -1.0).argmax()) + 1)
    return sorted(chosen)


class Compared:
    """The documented steps of a run, each solved again as far as it is looked at.

    Parameters
    ----------
    run : Run
    """

    def __init__(self, run: Run) -> None:
        self.run = run
        self.steps = [run.at(k) for k in documented_steps(run)] if run.searched else []

    @cached_property
    def held_in_ellipsoid(self) -> dict[str, int]:
        """Bodies that fall out of balance or slip in the corners of the pyramid alone: the step.

        Not those next to a body that is out of balance in the ellipsoid, too: of a pile that falls
        it is not determined which of its bodies lack a force.
        """
        held: dict[str, int] = {}
        neighbours = [self.run.bodies(pair) for pair in self.run.pairs]
        for at in self.steps:
            if not at.slips_inside:
                continue
            falling = set(at.unbalanced_in_ellipsoid)
            falling |= {name for names in neighbours if falling & {*names} for name in names}
            for name in at.unbalanced:
                if name not in falling:
                    held.setdefault(name, at.k)
        return held

    @cached_property
    def unbalanced(self) -> dict[str, Missing]:
        """Bodies that are not in equilibrium, each where most is missing."""
        worst: dict[str, Missing] = {}
        for at in self.steps:
            for name, missing in at.unbalanced.items():
                if name not in self.held_in_ellipsoid:
                    worst[name] = max(worst.get(name, missing), missing)
        return worst
