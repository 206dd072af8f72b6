"""A backend's own answer, of which nothing is claimed, in few calls."""

import numpy as np

from quasistatic_ref.certify.solution import SolverStatistics
from quasistatic_ref.optional.fast.compiled.forces import FastSolution, ForcesOfSteps
from quasistatic_ref.optional.fast.posed import posed
from quasistatic_ref.optional.fast.solver import FastSolver
from quasistatic_ref.solve.solve import NOTHING_CLAIMED
from quasistatic_ref.solve.units import Units, in_si
from quasistatic_ref.step.arrays import finite, read_only, without_warnings
from quasistatic_ref.step.data import StepData

SAME = {
    "lam_extra": read_only(np.zeros(0)), "certificate": NOTHING_CLAIMED, "net_impulse": None,
    "alone": True,
}  # fmt: skip
"""What all these solutions have in common."""


def as_said(
    step: StepData,
    solver: FastSolver,
    units: Units | None,
    accuracy: float,
    in_c: ForcesOfSteps | None,
) -> FastSolution | None:
    """The solution of a step whose program compiled code has written, as the backend gives it.

    Parameters
    ----------
    step : StepData
    solver : FastSolver
    units : Units or None
        In which its program is written; None if it is not.
    accuracy : float
        In natural units [-].
    in_c : ForcesOfSteps or None
        As of the solution.

    Returns
    -------
    FastSolution or None
        That of :func:`~quasistatic_ref.solve.solve.solved` with ``certify="off"``, to the last bit;
        None where `solved` has more to do: further options to try, rows out of reach, or a step to
        refuse.
    """
    if units is None or solver.adapter.NEAR:
        return None
    return without_warnings(_as_said, step, solver, units, accuracy, in_c)


def _as_said(
    step: StepData,
    solver: FastSolver,
    units: Units,
    accuracy: float,
    in_c: ForcesOfSteps | None,
) -> FastSolution | None:
    option_set = solver.option_sets(accuracy)[0]
    try:
        reply = solver.reply(option_set, None)
    except Exception:  # whatever another package raises: `solved` tries again
        return None
    if not reply.solved or reply.x is None or reply.lam is None:
        return None
    delta_q, lam = in_si(reply.x, reply.lam, units)
    if not (finite(delta_q) and finite(lam)):
        return None
    solver.written = None
    statistics = SolverStatistics(
        solver.name,
        "optimal",
        reply.iterations,
        reply.seconds,
        option_set.accuracy,
        interface=solver.interface,
    )
    own = {
        "delta_q": read_only(delta_q), "lam": read_only(lam), "step": step,
        "backend": solver.name, "statistics": statistics, "in_c": in_c,
    }  # fmt: skip
    return posed(FastSolution, SAME, own)
