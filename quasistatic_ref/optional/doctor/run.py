"""A run at its end: what findings after the run look at."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.optional.doctor.artifacts import gap_after, quotient, ways_of
from quasistatic_ref.optional.doctor.asked import Asked
from quasistatic_ref.optional.doctor.bodies import Body, bodies
from quasistatic_ref.optional.doctor.measures import (
    PairMeasures,
    contact_mu,
    contact_slips,
    pair_measures,
    side,
    touching,
)
from quasistatic_ref.optional.doctor.start import Start
from quasistatic_ref.parts import is_there, part
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.observer import Recording
from quasistatic_ref.simulate.recorder import POINTS
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.solve.backends import DAQP
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData

if TYPE_CHECKING:
    from quasistatic_ref.step.contacts import Contacts
    from quasistatic_ref.step.extension import Posed
    from quasistatic_ref.step.solution import ContactForces, ForcesOfStep, StepSolution

NOTED = ("tau", "moved", "momentum", "gives")
"""What of a recorder, which may go, is kept: loads of each step, and what the observer notes."""
HELD = 1e-9
"""Change of a target that is none [m, rad, -]."""
ROUNDING = 1e-9
"""Load that is none, over a body's weight [-]."""


class Run(Start):
    """A run of one step at least.

    Parameters
    ----------
    recorder : Recording
    trajectory : Trajectory
    """

    def __init__(self, recorder: Recording, trajectory: Trajectory) -> None:
        super().__init__(recorder.simulator, recorder.start)
        self.tracks = recorder.tracks
        self.idle_columns = recorder.idle_columns
        self._noted = {name: recorder.noted(name) for name in NOTED}
        self.trajectory = trajectory
        self.arrays = trajectory.arrays
        self.steps = trajectory.steps
        self.complete = trajectory.failed is None
        self._last: RunStep | None = None

    @property
    def load_at_start(self) -> Array:
        """Gravity and what else pushes in the first step, shape (n_v,) [N, N m]."""
        return np.asarray(self.noted("tau")[0])

    @cached_property
    def pair_measures(self) -> list[PairMeasures]:
        """Measures of each pair in the run, computed from any record."""
        return pair_measures(self.trajectory, self.noted("moved"))

    def held_by(self, i: int) -> tuple[str, str]:
        """Names of the two sides of pair i: the one that nothing drives comes first."""
        pair = self.pairs[i]
        names = side(self.system, pair.alpha), side(self.system, pair.beta)
        return names if self.free[pair.alpha.link] else names[::-1]

    @cached_property
    def bodies_of(self) -> tuple[Body, ...]:
        """The groups of un-actuated coordinates that move together."""
        return tuple(bodies(self))

    @cached_property
    def body_of(self) -> Indices:
        """Number of the body of each coordinate, (n_v,): their count where it is of none."""
        of = np.full(self.system.n_v, len(self.bodies_of))
        for i, body in enumerate(self.bodies_of):
            of[body.coordinates] = i
        return of

    @cached_property
    def lengths(self) -> Mask:
        """Which coordinates are lengths, shape (n_v,)."""
        return np.array([c.unit == "m" for c in self.system.coordinates], dtype=bool)

    @cached_property
    def near(self) -> dict[str, list[Body]]:
        """The bodies of each pair, by its name."""
        of_pair: dict[str, list[Body]] = {pair.name: [] for pair in self.pairs}
        for body in self.bodies_of:
            for i in np.unique(self.pair_of[body.contacts]).tolist():
                of_pair[self.pairs[i].name].append(body)
        return of_pair

    @cached_property
    def touches(self) -> Mask:
        """Which contacts touch, (steps, n_c), with load or without: which bears may be open."""
        return touching(self.trajectory, self.noted("moved"))

    def largest(self, contacts: Mask) -> float:
        """Largest sum of the normal forces of some contacts, after the first step [N]."""
        sums = self["wrench"][:, contacts, 2].sum(axis=1)
        return float(sums[min(1, self.steps - 1) :].max())

    def slid(self, i: int) -> Array:
        """Mean slip, as a vector of the world [m], and spin [rad] of a pair's contacts that touch.

        In each step, shape (steps, 4); what goes up and down again has slid nowhere in their sum.
        """
        of = self.pair_of == i
        on = self.touches[:, of, None]
        moved = self.noted("moved")[:, of]
        n = self["n"][:, of]
        along = moved[..., :3] - np.vecdot(moved[..., :3], n)[..., None] * n
        spins = np.where(self["rows"][of, None] == 6, moved[..., 3:], 0.0)
        total = np.where(on, np.concatenate([along, spins], axis=2), 0.0).sum(axis=1)
        return np.asarray(total / np.maximum(on.sum(axis=1), 1))

    def ways(self, i: int) -> Array:
        """How far a pair slid [m] and spun [rad] in the run, shape (2,)."""
        return ways_of(self.slid(i).sum(axis=0))

    @cached_property
    def asked(self) -> Asked:
        """The results of the steps that were asked: missing forces, and what the model adds."""
        return Asked(self)

    @cached_property
    def mu(self) -> Array:
        """(mu_v, mu_v, mu_omega) of contacts, shape (n_c, 3) [-, -, m]."""
        return contact_mu(self.trajectory)

    @cached_property
    def slips(self) -> Array:
        """Slips along d1 and d2 [m] and turns of what has torsion [rad], shape (steps, n_c, 3)."""
        return contact_slips(self.trajectory, self.noted("moved"))

    @property
    def scaled_slips(self) -> Array:
        """Slips and turns multiplied by mu_v and mu_omega, shape (steps, n_c, 3) [m]."""
        return self.mu * self.slips

    @cached_property
    def targets_move(self) -> Mask:
        """Whether a target moves in each step, shape (steps,): where none does, bodies settle."""
        ways = np.abs(np.diff(self["q_bar_a"], axis=0)).max(axis=1, initial=0.0) > HELD
        return np.concatenate([ways[:1], ways]) if len(ways) else np.zeros(self.steps, dtype=bool)

    def inertia(self, body: Body) -> Array:
        """The inertia of a body at the start, shape (n, n) [kg, kg m, kg m^2]."""
        return body.inertia(self.masses, self.system.n_a)

    @cached_property
    def drags(self) -> dict[Body, Array]:
        """What inertia bears of each body's load in each step, shape (steps,) [N].

        0 where float64 has no number for it, as with an h of 1e-308 s.
        """
        of_bodies = {}
        for body in self.bodies_of:
            momentum = self.noted("momentum")[:, body.coordinates - self.system.n_a]
            amount = body.amount(self.inertia(body), momentum)
            of_bodies[body] = quotient(quotient(amount, self.h), self.h)
        return of_bodies

    @cached_property
    def loads(self) -> dict[Body, Array]:
        """Each body's own load in each step, shape (steps,) [N].

        It is what gravity and other loads are, or the largest force of a pair on it in the run. A
        load below the rounding of its weight is none.
        """
        of_bodies = {}
        for body in self.bodies_of:
            tau = body.amount(self.inertia(body), self.noted("tau")[:, body.coordinates])
            pairs = np.unique(self.pair_of[body.contacts]).tolist()
            forces = [self["wrench"][:, self.pair_of == i, 2].sum(axis=1) for i in pairs]
            least = ROUNDING * body.mass * self.g
            pressed = float(np.max(forces, initial=least)) or (0.0 if tau.any() else 1.0)
            of_bodies[body] = np.maximum(tau, pressed)
        return of_bodies

    def loads_at(self, k: int, q: Array) -> Array:
        """Gravity at q and the other loads of step k, shape (n_v,) [N, N m].

        Forces and torques on free bodies keep their directions in the world.

        Parameters
        ----------
        k : int
        q : ndarray, shape (n_q,)
        """
        q_k = self["q"][k]
        force = self.noted("tau")[k] - self.simulator.generalised_force(q_k, None)
        at = np.array([base.v.start for base in self.free_bases.values()], dtype=np.int64)
        if force.any() and at.size:
            of_base = at[:, None, None] + np.arange(6).reshape(2, 3)
            links = [self.system.link(name) for name in self.free_bases]
            R_k, R = (self.system.kinematics(x).R[links] for x in (q_k, q))
            force[of_base] = force[of_base] @ R_k.swapaxes(1, 2) @ R
        return self.simulator.generalised_force(q, force)

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.arrays[name]

    def noted(self, name: str) -> NDArray[Any]:
        """What the recorder keeps of each step and the trajectory does not, shape (steps, ...)."""
        return self._noted[name]

    @cached_property
    def gap(self) -> Array:
        """Gaps after each step, shape (steps, n_c) [m]."""
        return gap_after(self["phi"], self["n"], self.noted("moved"))

    @cached_property
    def points(self) -> ClosestPoints:
        """The contacts of the first step."""
        return self.points_of(0)

    def points_of(self, k: int) -> ClosestPoints:
        """The recorded contacts of step k, without the record's ties."""
        fields = {name: self[name][k] for name in POINTS}
        return ClosestPoints(**fields, tie=np.zeros_like(fields["point"]))

    @property
    def searched(self) -> bool:
        """Whether steps of the run can be solved again, as convex steps without extension."""
        convex = self.simulator.law == CONVEX
        return self.small and convex and self.simulator.extension is None

    @property
    def own_terms(self) -> bool:
        """Whether a user's own costs or constraints are more than rows and rises."""
        if self.extension is None:
            return False
        posed: Posed = part("posed")
        return not posed(self.at(0).step, self.extension)[1]

    def at(self, k: int) -> RunStep:
        """Step k, which is kept until another is asked for."""
        if self._last is None or self._last.k != k:
            self._last = RunStep(self, k)
        return self._last

    def axes(self, k: int, contacts: Mask | Indices | slice) -> tuple[Array, Array]:
        """The tangents d1 and d2 of some contacts in step k, shape (n, 3) each [-]."""
        return self["d1"][k, contacts], self["d2"][k, contacts]

    def solved(self, step: StepData) -> StepSolution:
        """The solution of a step, unproved; QuasistaticError if no backend has an answer."""
        backend = DAQP if self.simulator.backend == DAQP else None
        return solve_step(step, backend, certify="off")


class RunStep:
    """A step of a run.

    Parameters
    ----------
    run : Run
    k : int
        Of the step.
    """

    def __init__(self, run: Run, k: int) -> None:
        self.run = run
        self.k = k

    @property
    def contacts(self) -> Contacts:
        """The contacts of the step."""
        return self.step.contacts

    @cached_property
    def step(self) -> StepData:
        """The problem of the step, up to rounding."""
        run = self.run
        k = self.k
        load = run.noted("tau")[k]
        return run.simulator.step_at(run["q"][k], run["q_bar_a"][k], load, run.points_of(k))

    @cached_property
    def compliant(self) -> ContactForces | None:
        """The step's contact forces by compliance; None where they are not rational.

        None if the run is not `searched`, or there is no optional/forces.
        """
        polyhedral = cone(self.run.simulator.cone).polyhedral
        if not (self.run.searched and polyhedral and is_there("contact_forces")):
            return None
        contact_forces: ForcesOfStep = part("contact_forces")
        return contact_forces(self.step, None, self.near)

    @property
    def near(self) -> tuple[Array, Array]:
        """delta_q, shape (n_v,) [m, rad], and forces of contacts, (n_c, 4) [N, N m], of the run."""
        return self.run["delta_q"][self.k], self.run["wrench"][self.k]

    @cached_property
    def forces(self) -> Array:
        """Forces of single contacts, shape (n_c, 4) [N, N m].

        They are unique. Where they cannot be formed, what the multipliers of the step combine to.
        """
        compliant = self.compliant
        return np.asarray(self.run["wrench"][self.k]) if compliant is None else compliant.wrench
