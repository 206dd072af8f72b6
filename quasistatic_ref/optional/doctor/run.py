"""A run at its end: what findings after the run look at."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.model.screw import rows
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.doctor.measures import (
    PairMeasures,
    contact_mu,
    contact_slips,
    gap_after,
    pair_measures,
    side,
    touching,
)
from quasistatic_ref.optional.doctor.start import Start
from quasistatic_ref.parts import part
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.observer import Recording
from quasistatic_ref.simulate.recorder import POINTS
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import StepData

if TYPE_CHECKING:
    from quasistatic_ref.step.contacts import Contacts
    from quasistatic_ref.step.extension import Posed

NOTED = ("tau", "moved", "momentum", "gives")
"""What of a recorder, which may go, is kept: loads of each step, and what the observer notes."""
HELD = 1e-9
"""Change of a target that is none [m, rad, -]."""
SAME = 1e-6
"""Change of a load that is none, over the largest of its body [-]."""


def in_world(quaternions: Array, vectors: Array) -> Array:
    """Vectors of a body's own frame, (steps, 3), in the world, by its quaternions, (steps, 4).

    `quaternions` [-] are those of each step, `vectors` [any unit] too.
    """
    R: Array = np.array(rows(list(quaternions.T)))
    turned: Array = np.einsum("ijk,kj->ki", R, vectors)
    return turned


class Run(Start):
    """A run of at least one step, as the checks of findings read it.

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
        """Gravity and external loads in the first step, shape (n_v,) [N, N m]."""
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
    def touches(self) -> Mask:
        """Which contacts touch, (steps, n_c), with load or without: which bears may be open."""
        return touching(self.trajectory, self.noted("moved"))

    def largest(self, contacts: Mask) -> float:
        """Largest sum of the normal forces of some contacts, after the first step [N]."""
        sums = self["wrench"][:, contacts, 2].sum(axis=1)
        return float(sums[min(1, self.steps - 1) :].max())

    @cached_property
    def mu(self) -> Array:
        """mu_v, mu_v and mu_omega of each contact, shape (n_c, 3) [-, -, m]."""
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

    @cached_property
    def loads_move(self) -> Mask:
        """Whether a load on a free body changes in each step, shape (steps,), seen in the world."""
        moves = np.zeros(self.steps, dtype=bool)
        for base in self.free_bases.values():
            q = self["q"][:-1, base.q][:, 3:]
            load = self.noted("tau")[:, base.v]
            for part_of in (load[:, :3], load[:, 3:]):
                change = np.abs(np.diff(in_world(q, part_of), axis=0)).max(axis=1)
                moves[1:] |= change > SAME * np.abs(load).max()
        return moves

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.arrays[name]

    def noted(self, name: str) -> NDArray[Any]:
        """Numbers of each step that the recorder keeps, not the trajectory, shape (steps, ...)."""
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


class RunStep:
    """One step of a run, formed again from its record.

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
    def posed(self) -> StepData:
        """The problem of the step with the rows, rises and quadratic costs of an extension."""
        extension = self.run.simulator.extension
        if extension is None:
            return self.step
        posed: Posed = part("posed")
        return posed(self.step, extension(self.run["q"][self.k]))[0]
