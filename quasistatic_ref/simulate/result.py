"""What one step of a simulator came to."""

from dataclasses import dataclass, field

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.optional.show.show import shown
from quasistatic_ref.optional.show.simulate_words import NOT_IN_TEXT, result_page
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.solution import StepSolution


@dataclass(frozen=True, eq=False)
class StepResult(Plain):
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

    __repr__, _repr_html_ = shown(result_page, *NOT_IN_TEXT)
