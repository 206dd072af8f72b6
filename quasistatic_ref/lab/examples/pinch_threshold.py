"""Two fingers hold a bar off its centre of mass: how hard they have to press.

With torsional friction the bar's weight m g has a lever d that the fingers can resist. In the
paper's pyramid the normal force is shared: N = m g / (2 mu_v) + m g d / (2 mu_omega), (R21).
"""

from functools import partial

import numpy as np

from quasistatic_ref.figures import Figure, styled
from quasistatic_ref.lab.examples.runs import Numbers, script
from quasistatic_ref.lab.figures.cones import pinch_thresholds
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.pinch import pinch_step
from quasistatic_ref.lab.validate.measures import threshold
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import Array

M, MU_V, MU_OMEGA, D = 0.2, 0.5, 0.02, 0.03
PRECISION = 1e-6
STILL = 1e-12
"""Motion below this [m, rad] is none: answers are exact, or enclosed to 1e-18 of a millimetre."""

SHARES = (0.97, 1.03)
"""Of the least squeeze: one slips, the other holds."""


def holds(cone: str, squeeze: float, d: float = D) -> bool:
    """Whether one exact step leaves the bar where it is, at a squeeze [N] and a lever [m]."""
    step = pinch_step(squeeze, d, MU_V, MU_OMEGA, m=M, cone=cone)
    motion = step.contacts.J @ solve_step(step).delta_q
    return bool(np.abs(motion).max() < STILL)


def least_squeezes(d: Array) -> dict[str, Array]:
    """Cone -> the least squeeze that holds the bar [N], at levers [m]; shapes (N,)."""
    slide, spin = M * GRAVITY / (2 * MU_V), M * GRAVITY * d / (2 * MU_OMEGA)
    return {
        "pyramid": slide + spin,  # (R21)
        "ellipsoid": np.hypot(slide, spin),  # (R22)
        "product": np.maximum(slide, spin),  # (R23)
    }


def main() -> Numbers:
    """The least squeeze by bisection on steps, and in closed form."""
    least = least_squeezes(np.array([D]))
    return {
        "least squeeze, pyramid [N]": threshold(partial(holds, "pyramid"), 0.1, 100.0, PRECISION),
        "(R21) [N]": float(least["pyramid"][0]),
        "least squeeze, product [N]": threshold(partial(holds, "product"), 0.1, 100.0, PRECISION),
        "(R23) [N]": float(least["product"][0]),
    }


@styled
def figure(offsets: int = 5) -> Figure:
    """The least squeeze against the lever, in three cones.

    Parameters
    ----------
    offsets : int
        Number of levers.
    """
    d = np.linspace(0.0, 0.06, offsets)
    least = least_squeezes(d)
    slips = {
        cone: {
            share: ~np.array([holds(cone, share * N, x) for N, x in zip(squeezes, d, strict=True)])
            for share in SHARES
        }
        for cone, squeezes in least.items()
    }
    return pinch_thresholds(d, least, slips)


if __name__ == "__main__":
    script(main, figure)
