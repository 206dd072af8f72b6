"""Figure 4 of the paper: where the time of a step goes.

Almost 3,000 signed distances are evaluated in each step of the grasp, and yet most of the time goes
into the quadratic program and the proof of its answer. The milliseconds are those of this machine.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from quasistatic_ref.figures import styled
from quasistatic_ref.figures.validation import PICTURES
from quasistatic_ref.lab.examples.runs import Numbers, script
from quasistatic_ref.lab.validate.paper.step_time import evidence

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def main() -> Numbers:
    """Milliseconds of a step, and the share of each part."""
    picture = evidence().picture
    shares = {f"share of {part} [-]": share for part, share in picture["shares"].items()}
    return {"time of a step [ms]": picture["milliseconds"], **shares}


@styled
def figure() -> Figure:
    """Shares as bars."""
    return PICTURES["step_time"](evidence().picture)


if __name__ == "__main__":
    script(main, figure)
