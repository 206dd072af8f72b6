"""After Figure 4 of the paper: where the time of a step goes.

The paper says that a majority of it goes into the quadratic program, although almost 3,000 signed
distances are evaluated. Here that depends on the solver, and on whether all distances are evaluated
or a tracker leaves out those that cannot matter. The times are those of this machine.
"""

from typing import Any

from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.validation import PICTURES
from quasistatic_ref.lab.study.bench.profile import measured
from quasistatic_ref.optional.show.figures import Figure


def main() -> Numbers:
    """Time of a step and share of its solve by backend, distances and certificate."""
    found = measured()
    numbers = {
        "signed distances by brute force [-]": float(found["all"]),
        "signed distances with the tracker, mean [-]": found["tracked"],
    }
    for profile in found["profiles"].all:
        numbers[f"{profile.name}: step [us]"] = sum(profile.typical.values())
        numbers[f"{profile.name}: share of the solve [-]"] = profile.solve
    return numbers


def figure(ax: Any = None) -> Figure:
    """All parts, as stacked bars.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    """
    return PICTURES["step_time"](measured(), ax)
