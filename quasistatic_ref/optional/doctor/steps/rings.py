"""Actuated coordinates that jump to and fro, since gravity is taken where a step starts."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.optional.doctor.frame.run import Run
from quasistatic_ref.optional.doctor.frame.start import SHORT
from quasistatic_ref.optional.doctor.texts import finding
from quasistatic_ref.simulate.finding import Finding

STEPS = 10
"""Steps, at the end of a run, in which targets and loads stay."""
TURNS = 7
"""Of these, in which the coordinate turns back, at least."""
NEARER = 0.5
"""Part of a jump that is left after these steps [-], of what comes to rest."""


def ringing(run: Run) -> dict[int, float]:
    """Actuated coordinates that jump to and fro at the end, and their last jumps [m, rad]."""
    jumps = run["delta_q"][-STEPS - 1 :, : run.system.n_a]
    if len(jumps) <= STEPS or run.targets_move[-STEPS:].any():
        return {}
    turns = (jumps[1:] * jumps[:-1] < 0).sum(axis=0) >= TURNS
    first, last = (np.abs(of).max(axis=0) for of in (jumps[:3], jumps[-3:]))
    rings = np.flatnonzero(turns & (last > NEARER * first) & (last > SHORT)).tolist()
    return {} if rings and _loads_move(run) else {i: float(last[i]) for i in rings}


def _loads_move(run: Run) -> bool:
    """Whether loads but gravity change in the last steps."""
    ends = [run.steps - STEPS, run.steps - 1]
    gravity = [run.simulator.generalised_force(run["q"][k], None) for k in ends]
    first, last = run.noted("tau")[ends] - gravity
    return bool(np.abs(first - last).max() > SHORT * np.abs(run.noted("tau")).max())


def rings(run: Run) -> Iterator[Finding]:
    """The coordinate whose spring is softest for the slope of its load."""
    every = ringing(run)
    if not every:
        return
    i = max(every, key=every.__getitem__)
    coordinate = run.system.coordinates[i]
    joint = run.system.joint(coordinate.joint)
    at = run["q"][-2:, joint.q][:, i - joint.v.start]
    unit = "N/m" if coordinate.unit == "m" else "N m/rad"
    K = run.simulator.K_q[i, i]
    cause = f"{coordinate.name} goes to and fro between {at.max():.4g} and {at.min():.4g} "
    cause += f"{coordinate.unit}: its spring, {K:.3g} {unit}, is softer than its load's slope"
    remedy = f"raise K_q of {joint.name}, or set gravity_compensated, or do not actuate it"
    yield finding("rings", cause, remedy, joint.name, jump=every[i], K_q=K)
