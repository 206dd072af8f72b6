"""How the steps of a run were solved: where the backend failed, and what their proofs cost."""

from collections.abc import Iterator
from math import log10

import numpy as np

from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.solve.backends import NONE, QPSOLVERS
from quasistatic_ref.step.cones import cone

WORTH = 10.0
"""Least time of a run whose proofs are named [s]."""
SHARE = 0.8
"""Of the time of such a run, above which its proofs are named [-]."""


def backend_failures(run: Run) -> Iterator[Finding]:
    """Steps whose exact optimum the backend missed.

    An accuracy of 10^-2k gives k digits of delta_q: by strong convexity the error is the square
    root of twice the gap.
    """
    simulator = run.simulator
    digits = run["digits"]  # NaN without an answer, or where the optimum is not known
    unanswered = np.zeros(run.steps, dtype=bool)
    unanswered[run.trajectory.header.get("unanswered", [])] = True
    asked = -log10(simulator.accuracy) / 2
    if not cone(simulator.cone).polyhedral:
        asked = 0.0  # an enclosure may be no nearer than the answer
    failed = int(unanswered.sum())
    short = int((digits < asked).sum())
    if simulator.backend == NONE or not failed + short:
        return
    missed = unanswered | (digits < asked)
    first = int(np.flatnonzero(missed)[0])
    exact = (run["certificate"][missed] == "exact").all()
    other = "the exact method" if exact else "another backend or the exact method"
    able = ("clarabel", "daqp") if cone(simulator.cone).polyhedral else ("clarabel", "scs")
    others = [name for name in able if name != simulator.backend.removeprefix(QPSOLVERS)]
    said = f"failed in {failed} of {run.steps} steps" if failed else ""
    fewer = f"had fewer than the {asked:g} digits that were asked for in {short}" if short else ""
    yield Finding(
        "failing backend",
        True,
        f"choose another backend than {simulator.backend}, such as {' or '.join(others)}",
        f"{simulator.backend} {' and '.join(filter(None, (said, fewer)))}, the first of them step "
        f"{first}; {other} solved them",
        {"failed": failed, "short": short, "step": first},
    )


def proofs(trajectory: Trajectory) -> Iterator[Finding]:
    """A run that was proved in full, and could have had bounds of its errors in less time."""
    proved = np.isin(trajectory["certificate"], ("exact", "enclosure")).any()
    if not proved or trajectory.header.get("law", CONVEX) != CONVEX:
        return
    total = sum(float(seconds.sum()) for seconds in trajectory.seconds.values())
    proof = float(trajectory.seconds["proof"].sum())
    if total > WORTH and proof > SHARE * total:
        yield Finding(
            "time of proof",
            False,
            'take certify = "residual", which bounds the error of each step in less time',
            f"proofs took {proof:.0f} s of the {total:.0f} s of these steps",
            {"proof_s": proof, "total_s": total},
        )
