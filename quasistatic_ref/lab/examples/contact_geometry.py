"""After Figure 2 of the paper, from data: alpha, beta, phi and the frame {d1, d2, n} of a contact.

A capsule and a box, their closest points and the normal from the one to the other. The derivative
of the signed distance phi with respect to q is n'J, which is what makes a row of Eq. (4) linear.
"""

from typing import Any

import numpy as np

from quasistatic_ref.lab.examples.shared import Numbers
from quasistatic_ref.lab.figures.validation import PICTURES
from quasistatic_ref.lab.scenes.free_pair import capsule_and_box, geometry, outline
from quasistatic_ref.optional.show.figures import Figure

DIFFERENCE = 1e-6
"""Of q, either way, for a derivative by differences [m, rad]."""


def main() -> Numbers:
    """The pair that is drawn: its distance twice, and the defects of phi, frame and derivative."""
    system, pair, q = capsule_and_box()
    points, found = geometry(system, pair, q)
    gap, n = points.beta - points.alpha, points.n
    frame = np.stack([found.d1[0], found.d2[0], found.n[0]])
    # Row k of `ahead` and `behind` is phi where coordinate k alone has moved.
    ahead, behind = (
        [geometry(system, pair, system.integrate(q, e))[0].phi for e in way * np.eye(system.n_v)]
        for way in (DIFFERENCE, -DIFFERENCE)
    )
    slope = np.ravel(np.subtract(ahead, behind)) / (2 * DIFFERENCE)
    return {
        "phi [mm]": 1e3 * float(points.phi[0]),
        "|beta - alpha| [mm]": 1e3 * float(np.linalg.norm(gap)),
        "|beta - alpha - phi n| [m]": float(np.abs(gap - points.phi[0] * n).max()),
        "defect of the frame [-]": float(np.abs(frame @ frame.T - np.eye(3)).max()),
        "|d phi / d q - n'J| [-]": float(np.abs(slope - found.n[0] @ found.J[0, :3]).max()),
    }


def figure(ax: Any = None) -> Figure:
    """The pair, seen along d1.

    Parameters
    ----------
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    """
    return PICTURES["contact_geometry"]({"outline": outline()}, ax)
