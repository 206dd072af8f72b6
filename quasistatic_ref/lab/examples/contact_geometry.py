"""After Figure 2 of the paper, from data: alpha, beta, phi and the frame {d1, d2, n} of a contact.

A capsule and a box, their closest points and the normal from the one to the other. The derivative
of the signed distance phi with respect to q is n'J, which is what makes a row of Eq. (4) linear.
"""

from functools import cache
from typing import Any

import numpy as np

from quasistatic_ref.figures import Figure
from quasistatic_ref.lab.examples.runs import Numbers, script
from quasistatic_ref.lab.figures.validation import PICTURES
from quasistatic_ref.lab.validate.claim import Evidence
from quasistatic_ref.lab.validate.paper.contact_geometry import evidence


@cache
def measured() -> Evidence:
    """Points against four shapes at random poses, and the pair that is drawn."""
    return evidence()


def main() -> Numbers:
    """The drawn pair, and the worst defect of phi, frame and derivative over all poses."""
    drawn = measured().picture["outline"]
    gap, _, frame, derivative = measured().comparisons
    return {
        "phi [mm]": 1e3 * float(drawn["phi"][0]),
        "|beta - alpha| [mm]": 1e3 * float(np.linalg.norm(drawn["beta"] - drawn["alpha"])),
        "worst |beta - alpha - phi n| [m]": gap.errors.max(),
        "worst defect of a frame [-]": frame.errors.max(),
        "worst |d phi / d q - n'J| [-]": derivative.errors.max(),
    }


def figure(ax: Any = None) -> Figure:
    """The pair, seen along d1.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    """
    return PICTURES["contact_geometry"](measured().picture, ax)


if __name__ == "__main__":
    script(main, figure)
