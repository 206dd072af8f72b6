"""A peg that touches its hole at two points: wedged, or free to go in (Whitney 1982).

(R17): for a descent s, a turn theta and a motion x across the hole, the rows of the two contacts
are x + theta l / 2 >= mu |s - theta d / 2| and -x + theta l / 2 >= mu |s + theta d / 2|. Their
sum, theta l >= mu max(2 s, theta d), has a solution with s > 0 if and only if l >= mu d, because
the larger of the two terms is at least theta d. For l > mu d both rows are tight, and both
multipliers are positive if I + mu^2 m d^2 / 4 >= mu m d l / 4, as for every uniform rectangle of
height at least l.
"""

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.lab.scenes.contacts import X, Y, Z
from quasistatic_ref.lab.scenes.rigid import rigid_step
from quasistatic_ref.lab.thresholds import exact, grid, thresholds
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import CLOSED_FORM

M = 0.3
H = 0.01
INERTIA = 2e-3
"""Of a peg long enough that both contacts go on pressing while it slides in [kg m^2]."""


def pushed_peg(depth: float, width: float, mu: float, force: float) -> StepData:
    """A peg pushed down by a force on its axis.

    It touches the mouth of the hole at its left and the wall at its right, `depth` lower and
    `width` apart; the centre of mass is midway.
    """
    points = [[-width / 2, 0.0, depth / 2], [width / 2, 0.0, -depth / 2]]
    frames = [[Y, Z, X], [Y, -Z, -X]]
    return rigid_step(M, INERTIA, (0, 0, -force, 0, 0, 0), points, frames, mu_v=mu, h=H)


def evidence() -> Evidence:
    """The depth at which the peg wedges, for weak and strong pushes; and how it slides deeper."""
    sweep = grid([0.01, 0.04], [0.1, 0.3, 0.8], [1e-3, 1.0, 1e6])
    widths, mus, _ = sweep.T
    expected = mus * widths
    measured = thresholds(pushed_peg, sweep, expected, (0.2, 5.0))
    wedged = (pushed_peg(0.99 * limit, *of) for limit, of in zip(expected, sweep, strict=True))
    rest = [exact(step).delta_q for step in wedged]
    solved = []
    formula = []
    for width, mu, over, force in grid([0.01, 0.04], [0.1, 0.3, 0.8], [1.05, 2, 6], [0.1, 5.0]):
        depth = over * mu * width
        solved.append(exact(pushed_peg(depth, width, mu, force)).delta_q)
        theta, x = 2 * mu / depth, -(mu**2) * width / depth  # per unit of descent
        descent = H**2 * force / (M * (1 + x**2) + INERTIA * theta**2)
        formula.append(descent * np.array([x, 0, -1, 0, theta, 0]))
    size = np.abs(formula).max(1, keepdims=True)
    return Evidence.of(
        comparison("depth below which it wedges [m]", measured, expected, CLOSED_FORM, expected),
        comparison("motion of a wedged peg [m, rad]", rest, 0.0, 0.0),
        comparison("motion of one that slides in [m, rad]", solved, formula, CLOSED_FORM, size),
    )


CLAIM = Claim(
    name="peg_wedging",
    sentence="A peg that touches its hole on both sides wedges at depths l < mu d, however hard "
    "it is pushed; deeper, it slides in, turning by 2 mu / l for each unit of descent.",
    where="docs/derivations.md (R17); D. E. Whitney, J. Dyn. Sys. Meas. Control 104 (1982), 65-77",
    sweep="two widths, three mu, pushes of 1 mN to 1 MN, three depths beyond the limit",
    reason="CLOSED_FORM; a wedged peg does not move at all, bit for bit.",
    measure=evidence,
)
