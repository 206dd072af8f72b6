"""Two fingers hold a bar off its centre of mass: how hard they have to press.

With torsional friction the bar's weight m g has a lever d that the fingers can resist. In the
paper's pyramid the normal force is shared: N = m g / (2 mu_v) + m g d / (2 mu_omega), (R21).
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.figures import styled
from quasistatic_ref.figures.cones import GRAVITY, bar_step, pinch_thresholds
from quasistatic_ref.lab.examples.runs import Numbers, script
from quasistatic_ref.lab.validate.bodies import threshold
from quasistatic_ref.solve.solve import solve_step

if TYPE_CHECKING:
    from matplotlib.figure import Figure

M, MU_V, MU_OMEGA, D = 0.2, 0.5, 0.02, 0.03
PRECISION = 1e-6


def holds(cone: str, squeeze: float) -> bool:
    """Whether one exact step leaves the bar where it is, at a squeeze [N]."""
    step = bar_step(M, squeeze, D, MU_V, MU_OMEGA, cone)
    motion = step.contacts.J @ solve_step(step).delta_q
    return bool(np.abs(motion).max() < 1e-12)


def main() -> Numbers:
    """The least squeeze by bisection on steps, and in closed form."""
    weight = M * GRAVITY
    return {
        "least squeeze, pyramid [N]": threshold(partial(holds, "pyramid"), 0.1, 100.0, PRECISION),
        "(R21) [N]": weight / (2 * MU_V) + weight * D / (2 * MU_OMEGA),
        "least squeeze, product [N]": threshold(partial(holds, "product"), 0.1, 100.0, PRECISION),
        "(R23) [N]": max(weight / (2 * MU_V), weight * D / (2 * MU_OMEGA)),
    }


@styled
def figure() -> Figure:
    """The least squeeze against the lever, in three cones."""
    return pinch_thresholds(M, MU_V, MU_OMEGA, offsets=5)


if __name__ == "__main__":
    script(main, figure)
