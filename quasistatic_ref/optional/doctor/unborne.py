"""Forces of single contacts that leave a part of the load, or that rounding decides."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.optional.between import Said
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.tolerances import BORNE, SURE

ROUNDING = 2.0**-40
"""Of sums in float64, over the sum of the sizes of all terms [-]."""


def unborne(run: Run) -> Iterator[Said]:
    """What forces leave in a step of a record of forces, of another run where contacts press most.

    What a last bit of the places of contacts may change in forces is that of the same step: beside
    a load that is rounding, any change is large.
    """
    recorded = run.arrays.get("imbalance")
    k = int(run["wrench"][:, :, 2].sum(axis=1).argmax())
    bit = float(np.spacing(np.abs(run["beta"][k]).max(initial=0.0)))
    left = 0.0 if recorded is None else float(recorded.max())
    found = run.compliant(k)
    if found is not None:
        left = max(left, found.imbalance)
    if left > BORNE:
        yield Said(
            "read wrench in the place of forces, or raise mu_v or mu_omega",
            f"forces of single contacts leave {left:.1e} of the load",
            {"left": left},
        )
    if found is None:
        return
    noise = found.sensitivity * bit
    if noise > SURE:
        yield Said(
            "read sums of forces only, or take a larger h or a softer K_q",
            f"the last bit of a gap, {bit:.1e} m, may change forces of single contacts by "
            f"{noise:.1e} of the load of their group",
            {"noise": noise},
        )
