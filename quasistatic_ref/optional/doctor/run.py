"""A run at its end: what findings after the run look at."""

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.account import pair_accounts, sides
from quasistatic_ref.optional.doctor.artifacts import LIGHT
from quasistatic_ref.optional.doctor.compared import Compared, RunStep
from quasistatic_ref.optional.doctor.start import SHORT, Start, least
from quasistatic_ref.simulate.account import PairAccount
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.observer import Recording
from quasistatic_ref.simulate.recorder import POINTS
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData

ACCURATE = ("clarabel", "daqp")
"""Backends whose answers have ten digits without a proof."""
FEW = 0.01
"""Motion that is none, over the longest of a contact in a step of the run [-]."""


class Run(Start):
    """A run of one step at least.

    Parameters
    ----------
    recorder : Recording
    trajectory : Trajectory
    """

    def __init__(self, recorder: Recording, trajectory: Trajectory) -> None:
        super().__init__(recorder.simulator, recorder.start)
        self.recorder = recorder
        self.trajectory = trajectory
        self.arrays = trajectory.arrays
        self.steps = trajectory.steps
        self.complete = trajectory.failed is None
        self._steps: dict[int, RunStep] = {}
        self._solvers: dict[str, Solver] = {}

    @cached_property
    def compared(self) -> Compared:
        """Its documented steps, solved again; none if it is not `searched`."""
        return Compared(self)

    @cached_property
    def pair_accounts(self) -> list[PairAccount]:
        """What its pairs did, whatever the record holds; without forces."""
        named = [sides(self.system, pair) for pair in self.pairs]
        return pair_accounts(self.trajectory, named, self.noted("moved"), None)

    @cached_property
    def light(self) -> float:
        """A force that is none [N]: a thousandth of what is free weighs, or presses in the run."""
        weight = sum(self.system.mass(name) for name in dict.fromkeys(self.owners)) * self.g
        pressed = self["wrench"][:, :, 2].sum(axis=1).max(initial=0.0)
        return LIGHT * max(weight, float(pressed))

    @cached_property
    def shortest(self) -> Array:
        """A motion of each pair that is none, shape (pairs,) [m].

        It is a millionth of its smaller shape, or a hundredth of the longest step of a contact in
        the run.
        """
        longest = np.linalg.norm(self.noted("moved")[:, :, :3], axis=2).max(initial=0.0)
        sizes = np.array([least(pair) for pair in self.pairs])
        return np.asarray(np.maximum(SHORT * sizes, FEW * longest))

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.arrays[name]

    def noted(self, name: str) -> NDArray[Any]:
        """What the recorder keeps of each step and the trajectory does not, shape (steps, ...)."""
        return self.recorder.noted(name)

    @cached_property
    def points(self) -> ClosestPoints:
        """The contacts of the first step."""
        return self.points_of(0)

    def points_of(self, k: int) -> ClosestPoints:
        """The contacts that step k has recorded, but for their ties."""
        fields = {name: self[name][k] for name in POINTS}
        return ClosestPoints(**fields, tie=np.zeros_like(fields["point"]))

    @property
    def searched(self) -> bool:
        """Whether a step of it may be solved once more, as a convex step without an extension."""
        convex = self.simulator.law == CONVEX
        return self.small and convex and self.simulator.extension is None

    def at(self, k: int) -> RunStep:
        """Step k, which is kept."""
        if k not in self._steps:
            self._steps[k] = RunStep(self, k)
        return self._steps[k]

    def solved(self, step: StepData) -> StepSolution | None:
        """A step, unproved; None where it is not solved."""
        try:
            return solve_step(step, self._solver(step), certify="off")
        except QuasistaticError:
            return None

    def _solver(self, step: StepData) -> Solver:
        """A solver of steps like one of the run, which is kept.

        It is that of the run if its answers are accurate without a proof, else the default.
        """
        last = self.simulator.solver
        if last is not None and last.name in ACCURATE and last.fits(step):
            return last
        fast = self.simulator.fast and cone(step.cone).polyhedral
        if step.cone not in self._solvers or not self._solvers[step.cone].fits(step):
            self._solvers[step.cone] = solver_for(step, fast=fast)
        return self._solvers[step.cone]


def largest(values: Array) -> float | None:
    """The largest of some values, shape (steps,) [any unit], those that are not known left out."""
    known = values[~np.isnan(values)]
    return float(known.max()) if known.size else None
