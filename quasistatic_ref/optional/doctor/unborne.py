"""Forces of single contacts that leave a part of the load, or that rounding decides."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.tolerances import BORNE, SURE

ROUNDING = 2.0**-40
"""Of sums in float64, over the sum of the sizes of all terms [-]."""


def unborne(run: Run) -> Iterator[Finding]:
    """What forces leave, and what rounding decides of them, where contacts press most.

    What a last bit of the places of contacts may change in forces is that of the same step: next to
    a load that is rounding, any change is large.
    """
    k = int(run["wrench"][:, :, 2].sum(axis=1).argmax())
    compliant = run.compliant(k)
    if compliant is None:
        return
    if compliant.imbalance > BORNE:
        yield Finding(
            "uncertain forces",
            False,
            "read wrench in the place of forces, or raise mu_v or mu_omega",
            f"forces of single contacts leave {compliant.imbalance:.1e} of the load",
            {"left": compliant.imbalance},
        )
    bit = float(np.spacing(np.abs(run["beta"][k]).max(initial=0.0)))
    noise = compliant.sensitivity * bit
    if noise > SURE:
        yield Finding(
            "uncertain forces",
            False,
            "read the sum of forces of each pair in the place of single ones, or take a softer K_q",
            f"rounding of a gap, by {bit:.1e} m, may change forces of single contacts by "
            f"{noise:.1e} of the load of their group",
            {"noise": noise},
        )
