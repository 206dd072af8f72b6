"""Documented steps of a run, solved again with one thing changed.

What an artifact of the model changes is seen where a step is solved again from the same state, with
the run's own contacts, cone and loads but for one thing. The answers are not proved.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.certify.contact_forces import forces_near
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.optional.doctor.artifacts import LIGHT
from quasistatic_ref.optional.doctor.equilibrium import missing_force
from quasistatic_ref.optional.doctor.start import (
    FARTHEST,
    SHORT,
    bodies,
    free_bases,
    least,
    slices,
    translations,
)
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.cones import ELLIPSOID, cone
from quasistatic_ref.step.data import Array, Mask, StepData
from quasistatic_ref.step.friction import slip_norms
from quasistatic_ref.tolerances import BEARS

if TYPE_CHECKING:
    from quasistatic_ref.contact.pairs import ContactPair
    from quasistatic_ref.optional.doctor.run import Run

SLOWER = 16.0
"""By what M_u is divided, and with it the drag [-]."""
ITERATES = 20
"""Convex steps in which Coulomb's law is looked for."""
SETTLED = 0.01
"""Change of rises and of normal forces, over the largest, at which Coulomb's law holds [-]."""
COUNTS = 0.1
"""Least difference that counts, over the larger of two numbers [-]."""
FEW = 0.01
"""Motion that is none, over the longest of a contact in a step of the run [-]."""
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


class Answer(NamedTuple):
    """A step, and what a backend says of it.

    Parameters
    ----------
    step : StepData
    delta_q : ndarray, shape (n_v,)
        [m, rad].
    wrench : ndarray, shape (n_c, 4)
        [N, N m].
    """

    step: StepData
    delta_q: Array
    wrench: Array


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


class LookedAt:
    """A documented step of a run.

    Parameters
    ----------
    run : Run
    k : int
        Of the step.
    """

    def __init__(self, run: Run, k: int) -> None:
        self.run = run
        self.k = k
        self.step = run.step_data(k)
        self.forces = run.forces(k)

    @cached_property
    def as_it_is(self) -> list[PairMotion]:
        """Of each pair, what it does in the run."""
        return self._pairs(self.run["delta_q"][self.k], self.forces)

    @cached_property
    def without_drag(self) -> list[PairMotion] | None:
        """The same with M_u / 16; None where it is not solved."""
        return self._solved(self.step.replace(M_u=self.step.M_u / SLOWER))

    @cached_property
    def by_coulomb(self) -> list[PairMotion] | None:
        """The same by Coulomb's law, to 1 %; None where no fixed point is reached."""
        answer = self._coulomb(self.step)
        return None if answer is None else self._pairs(answer.delta_q, self._forces(answer))

    def _coulomb(self, step: StepData) -> Answer | None:
        """A step by Coulomb's law: the convex step whose contacts are raised by their slips."""
        rise = np.zeros(step.contacts.n_c)
        last = np.inf
        for _ in range(ITERATES):
            answer = self._convex(step.replace(contacts=step.contacts.raised(rise)))
            if answer is None:
                return None
            slips = slip_norms(step.contacts, answer.delta_q, step.cone)
            normal = float(answer.wrench[:, 2].sum())
            off = np.abs(slips - rise).max(initial=0.0)
            if off <= SETTLED * slips.max(initial=0.0) and abs(normal - last) <= SETTLED * normal:
                return answer
            rise = slips
            last = normal
        return None

    def _convex(self, step: StepData) -> Answer | None:
        """A step, unproved."""
        try:
            solution = solve_step(step, self.run.solver_of(step), certify="off")
        except QuasistaticError:
            return None
        return Answer(step, solution.delta_q, solution.wrench)

    @cached_property
    def in_ellipsoid(self) -> list[PairMotion] | None:
        """The same in the ellipsoid; None where it is not solved."""
        return None if self._rounder is None else self._solved(self._rounder)

    @property
    def slips_inside(self) -> bool:
        """Whether a contact of a polyhedral cone slips with less friction than the circle has."""
        if not cone(self.step.cone).polyhedral:
            return False
        mu_v = self.step.contacts.mu_v
        friction = np.linalg.norm(self.forces[:, :2], axis=1)
        inside = (self._presses(self.forces) & (mu_v > 0)) & (
            friction < WITHIN * mu_v * self.forces[:, 2]
        )
        motion = self.step.contacts.motion(self.run["delta_q"][self.k])
        slip = np.hypot(*np.vecdot(motion[:, None, :3], self._tangents).T)
        return bool((inside & (slip > SHORT * self._sizes)).any())

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
        system = run.system
        contacts = step.contacts
        names = [system.coordinates[i].joint.partition("/")[0] for i in range(step.n_a, step.n_v)]
        masses = np.array([system.mass(name) for name in names])
        actuated = contacts.J[:, :, : step.n_a].any(axis=(1, 2))
        at_most = np.where(actuated, np.maximum(self.forces[:, 2], 0.0), np.inf)
        free = translations(system)
        missing = missing_force(step, self._touching, at_most, masses, free)
        unbalanced = {}
        for name in free_bases(system):
            coordinates = np.flatnonzero([other == name for other in names])
            amount = float(np.linalg.norm(missing[coordinates]))
            if amount > self.light:
                force, turn = np.split(missing[coordinates], [3])
                gyration = np.linalg.cholesky(step.inertia(coordinates))[3:, 3:]
                torque = gyration @ turn / np.sqrt(masses[coordinates[0]])
                lengths = float(np.linalg.norm(force)), float(np.linalg.norm(torque))
                unbalanced[name] = Missing(amount, *lengths, self.k)
        return unbalanced

    @property
    def _touching(self) -> Mask:
        phi = self.step.contacts.phi
        return np.asarray((phi <= SHORT * self._sizes) | self._presses(self.forces))

    @cached_property
    def _touched(self) -> set[str]:
        """Bodies that something touches."""
        touching = self._touching
        return {
            name
            for pair, of_pair in slices(self.run.pairs)
            if touching[of_pair].any()
            for name in bodies(self.run.system, pair)
        }

    @cached_property
    def light(self) -> float:
        """A force that is none [N]: a thousandth of what is free weighs, or presses in the run."""
        system = self.run.system
        free = {c.joint.partition("/")[0] for c in system.coordinates[self.step.n_a :]}
        weight = sum(system.mass(name) for name in free) * self.run.g
        pressed = self.run["wrench"][:, :, 2].sum(axis=1).max(initial=0.0)
        return LIGHT * max(weight, float(pressed))

    def _presses(self, forces: Array) -> Mask:
        return np.asarray(forces[:, 2] > BEARS * forces[:, 2].max(initial=0.0))

    @cached_property
    def shortest(self) -> Array:
        """A motion of each pair that is none, shape (pairs,) [m].

        It is a millionth of its smaller shape, or a hundredth of the longest step of a contact in
        the run.
        """
        moved = self.run.noted("moved")[:, :, :3]
        longest = np.linalg.norm(moved, axis=2).max(initial=0.0)
        sizes = [least(pair) for pair in self.run.pairs]
        return np.asarray(np.maximum(SHORT * np.minimum(sizes, FARTHEST), FEW * longest))

    @cached_property
    def floats(self) -> float:
        """The largest gap [m] of a contact that presses, on a layer of the steps before.

        By Coulomb's law there is none: a body comes down by as much, which is no motion of its own.
        """
        presses = self._presses(self.forces)
        return float(self.step.contacts.phi.max(where=presses, initial=0.0))

    def comes_down(self, pair: ContactPair) -> float:
        """A force [N] that comes of a free body's coming down from its layer in one step.

        It moves the body, and friction of its other contacts may turn round.
        """
        if self.floats <= SHORT * min(least(pair), FARTHEST):
            return 0.0
        system = self.run.system
        free = bodies(system, pair) & free_bases(system).keys()
        mass = sum(system.mass(name) for name in free)
        rubs = sum(
            other.mu_v * does.normal
            for other, does in zip(self.run.pairs, self.as_it_is, strict=True)
            if other is not pair and bodies(system, other) & free
        )
        return mass * self.floats / self.run.h**2 + 2 * rubs

    @property
    def _sizes(self) -> Array:
        """Extent of the smaller shape of each contact, shape (n_c,) [m]."""
        pairs = self.run.pairs
        return np.repeat([least(pair) for pair in pairs], [pair.n_c for pair in pairs])

    @property
    def _tangents(self) -> Array:
        contacts = self.step.contacts
        return np.stack([contacts.d1, contacts.d2], axis=1)

    def _solved(self, step: StepData) -> list[PairMotion] | None:
        answer = self._convex(step)
        return None if answer is None else self._pairs(answer.delta_q, self._forces(answer))

    def _forces(self, answer: Answer) -> Array:
        """Forces of single contacts, which are unique, shape (n_c, 4) [N, N m]."""
        if not cone(answer.step.cone).polyhedral:
            return answer.wrench
        try:
            return forces_near(answer.step, answer[1:]).wrench
        except QuasistaticError:
            return answer.wrench

    def _pairs(self, delta_q: Array, forces: Array) -> list[PairMotion]:
        motion = self.step.contacts.motion(delta_q)
        presses = self._presses(forces)[:, None]
        slip = np.where(presses, np.vecdot(motion[:, None, :3], self._tangents), 0.0)
        spin = np.where(presses[:, 0], np.abs(motion[:, 3]), 0.0)
        return [
            PairMotion(
                float(forces[i, 2].sum()),
                slip[i],
                float(spin[i].max(initial=0.0)),
            )
            for _, i in slices(self.run.pairs)
        ]


def documented_steps(run: Run) -> list[int]:
    """Three steps of a run: that of the largest motion, the last, and one where contacts change.

    The largest motion is that of a body that something touches, in the square root of its kinetic
    energy, or, where all is actuated, of a contact that presses. Of changes of which pairs press
    that is taken under the largest forces.
    """
    normal = run["wrench"][:, :, 2]
    presses = normal > BEARS * normal.max(axis=1, initial=0.0, keepdims=True)
    motion = np.zeros(run.steps)
    n_a = run.system.n_a
    inertia = np.diag(run.system.M_u(run.q_start))
    owner = np.array([c.joint.partition("/")[0] for c in run.system.coordinates[n_a:]])
    for name in dict.fromkeys(owner.tolist()):
        on = [name in bodies(run.system, pair) for pair in run.pairs for _ in range(pair.n_c)]
        touched = presses[:, np.array(on, dtype=bool)].any(axis=1)
        moved = run["delta_q"][:, n_a:] * np.where(owner == name, np.sqrt(inertia), 0.0)
        motion = np.maximum(motion, np.where(touched, np.linalg.norm(moved, axis=1), 0.0))
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
        self.steps = [LookedAt(run, k) for k in documented_steps(run)] if run.searched else []

    @cached_property
    def held_in_ellipsoid(self) -> dict[str, int]:
        """Bodies that fall out of balance or slip in the corners of the pyramid alone: the step.

        Not those next to a body that is out of balance in the ellipsoid, too: of a pile that falls
        it is not determined which of its bodies lack a force.
        """
        held: dict[str, int] = {}
        neighbours = [bodies(self.run.system, pair) for pair in self.run.pairs]
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
