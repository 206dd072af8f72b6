"""How the steps of a run were solved: failing backends, uncertain forces, and time of proofs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from math import log10
from typing import TYPE_CHECKING, Final

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.solve.backends import NONE, QPSOLVERS
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.cones import cone

if TYPE_CHECKING:
    pass

BORNE: Final = 1e-4
"""Share of the load [-] that forces of single contacts may leave without a finding."""

SURE: Final = 1e-3
"""Share of the load of a group [-] that noise in its gaps may change without a finding."""

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
    unanswered[list(run.trajectory.header.unanswered)] = True
    wanted = -log10(simulator.accuracy) / 2
    if not cone(simulator.cone).polyhedral:
        wanted = 0.0  # an enclosure may be no nearer than the answer
    failed = int(unanswered.sum())
    short = int((digits < wanted).sum())
    if simulator.backend == NONE or not failed + short:
        return
    missed = unanswered | (digits < wanted)
    first = int(np.flatnonzero(missed)[0])
    exact = (run["certificate"][missed] == "exact").all()
    other = "the exact method" if exact else "another backend or the exact method"
    others = ("clarabel", "daqp") if cone(simulator.cone).polyhedral else ("clarabel", "scs")
    able = [name for name in others if _solves(run, name, first, wanted)]
    remedy = f"choose another backend than {simulator.backend}, such as {' or '.join(able)}"
    if not able:
        remedy = "check masses, lengths and stiffness, or leave the steps to the exact method"
    errors = f"failed in {failed} of {run.steps} steps" if failed else ""
    fewer = f"had fewer than the {wanted:g} digits that were asked for in {short}" if short else ""
    yield Finding(
        "failing-backend",
        True,
        remedy,
        f"{simulator.backend} {' and '.join(filter(None, (errors, fewer)))}, the first of them "
        f"step {first}; {other} solved them",
        {"failed": failed, "short": short, "step": first},
    )


def _solves(run: Run, name: str, k: int, digits: float) -> bool:
    """Whether a backend is not the run's, and has some digits of step k if that may be solved."""
    failed = run.simulator.backend.removeprefix(QPSOLVERS)
    if name == failed or not run.searched:
        return name != failed
    with suppress(QuasistaticError):
        solved = solve_step(run.at(k).step, name, accuracy=run.simulator.accuracy).statistics
        return solved.digits is not None and solved.digits >= digits
    return False
