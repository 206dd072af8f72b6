"""What one step of a simulator came to."""

from dataclasses import dataclass, field

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.separations import OWN, SAYS
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.shown import Shown
from quasistatic_ref.step.data import Array, StepData


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
        Wall time of the parts: distances, rows, solve, integrate [s]; not compared.
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
