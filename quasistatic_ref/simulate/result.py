"""What one step of a simulator came to."""

from __future__ import annotations

from dataclasses import dataclass, field

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.separations import OWN, SAYS
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.shown import Shown
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.solution import StepSolution


@dataclass(frozen=True, eq=False, repr=False)
class StepResult(Plain, Shown):
    """Everything that one step came to.

    Parameters
    ----------
    q : ndarray, shape (n_q,)
        Configuration after the step.
    step : StepData
        The problem of the step.
    solution : StepSolution
    points : ClosestPoints
        Where the contacts were, before the step.
    seconds : dict of str to float
        Wall time of the parts: distances, rows, solve, proof, integrate [s]; not compared.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin")
    >>> simulator, q = scenario.simulator(), scenario.system.q_start
    >>> result = simulator.step(q, np.zeros(0))
    >>> result.solution.wrench[0, 2].round(6)  # the weight [N]
    np.float64(2.943)
    """

    q: Array
    step: StepData
    solution: StepSolution
    points: ClosestPoints
    seconds: dict[str, float] = field(compare=False)

    @property
    def tied(self) -> dict[str, str]:
        """The contacts whose normal was one of several, and how it was chosen, by their names."""
        chosen = zip(self.step.contacts.name, self.points.tie.tolist(), strict=True)
        return {name: SAYS[tie] for name, tie in chosen if tie != OWN}
