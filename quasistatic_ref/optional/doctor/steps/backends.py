"""Backends that fail, or have fewer digits than were asked for."""

from collections.abc import Iterator
from contextlib import suppress
from math import log10

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.optional.doctor.frame.run import Run
from quasistatic_ref.optional.doctor.texts import finding
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.solve.backends import NONE, QPSOLVERS
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.cones import cone


def backend_failures(run: Run) -> Iterator[Finding]:
    """Steps whose exact optimum the backend missed.

    An accuracy of 10^-2k gives k digits of delta_q: by strong convexity the error is the square
    root of twice the gap. An enclosure may be no nearer than the answer, and asks for none.
    """
    simulator = run.simulator
    polyhedral = cone(simulator.cone).polyhedral
    wanted = -log10(simulator.accuracy) / 2 if polyhedral else 0.0
    unanswered = np.isin(np.arange(run.steps), run.trajectory.header.unanswered)
    short = run["digits"] < wanted  # NaN without an answer, or where the optimum is not known
    missed = np.flatnonzero(unanswered | short)
    if simulator.backend == NONE or not missed.size:
        return
    first = int(missed[0])
    numbers = {"failed": int(unanswered.sum()), "short": int(short.sum()), "step": first}
    fewer = f"had fewer than the {wanted:g} digits that were asked for in {numbers['short']}"
    says = [f"failed in {numbers['failed']} of {run.steps} steps"] * bool(numbers["failed"])
    says += [fewer] * bool(numbers["short"])
    exact = (run["certificate"][missed] == "exact").all()
    other = "the exact method" if exact else "another backend or the exact method"
    cause = f"{simulator.backend} {' and '.join(says)}, the first of them step "
    cause += f"{first}; {other} solved them"
    others = "clarabel", "daqp" if polyhedral else "scs"
    able = " or ".join(name for name in others if _solves(run, name, first, wanted))
    remedy = "check masses, lengths and stiffness, or leave the steps to the exact method"
    if able:
        remedy = f"choose another backend than {simulator.backend}, such as {able}"
    yield finding("failing-backend", cause, remedy, **numbers)


def _solves(run: Run, name: str, k: int, digits: float) -> bool:
    """Whether a backend is not the run's, and has some digits of step k if that may be solved."""
    simulator = run.simulator
    if name == simulator.backend.removeprefix(QPSOLVERS):
        return False
    if not run.small or simulator.law != CONVEX or simulator.extension is not None:
        return True
    with suppress(QuasistaticError):
        solved = solve_step(run.step(k), name, accuracy=simulator.accuracy).statistics
        return solved.digits is not None and solved.digits >= digits
    return False
