"""Runs whose time went into exact proofs."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.optional.doctor.start import Said
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.trajectory import Trajectory

WORTH = 10.0
"""Least time of a run whose proofs are named [s]."""
SHARE = 0.8
"""Of the time of such a run, above which its proofs are named [-]."""


def proofs(trajectory: Trajectory) -> Iterator[Said]:
    """A run that was proved in full, and could have had bounds of its errors in less time."""
    proved = np.isin(trajectory["certificate"], ("exact", "enclosure")).any()
    if not proved or trajectory.header.get("law", CONVEX) != CONVEX:
        return
    total = sum(float(seconds.sum()) for seconds in trajectory.seconds.values())
    proof = float(trajectory.seconds["proof"].sum())
    if total > WORTH and proof > SHARE * total:
        yield Said(
            'take certify = "residual", which bounds the error of each step in less time',
            f"proofs took {proof:.0f} s of the {total:.0f} s of these steps",
            {"proof_s": proof, "total_s": total},
        )
