"""What a backend said to a step."""

from __future__ import annotations

from dataclasses import dataclass

from quasistatic_ref.step.data import Array
from quasistatic_ref.step.solution import SolverStatistics


@dataclass(eq=False)
class Answer:
    """What a solver returned.

    Parameters
    ----------
    delta_q : ndarray, shape (n_v,)
    lam : ndarray, shape (m,)
        Contact-major, the user's own rows last.
    statistics : SolverStatistics
    """

    delta_q: Array
    lam: Array
    statistics: SolverStatistics
