"""Actuated coordinates that jump to and fro, since loads are taken where a step starts."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.numbers.arrays import Array
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
WINDOW = 3
"""Jumps of which the largest counts, at the start and at the end of these steps."""
NEARBY = 1e-6
"""Difference of coordinates from which a slope is formed [m, rad]."""
ITERATIONS = 20
"""Newton's steps to the state of rest."""


def ringing(run: Run) -> dict[int, float]:
    """Actuated coordinates that jump to and fro at the end, and their last jumps [m, rad]."""
    jumps = run["delta_q"][-STEPS - WINDOW :, : run.system.n_a]
    if len(jumps) < STEPS + WINDOW or run.targets_move[-STEPS - WINDOW :].any():
        return {}
    turns = (jumps[-STEPS:] * jumps[-STEPS - 1 : -1] < 0).sum(axis=0) >= TURNS
    first, last = (np.abs(of).max(axis=0) for of in (jumps[:WINDOW], jumps[-WINDOW:]))
    rings = np.flatnonzero(turns & (last > NEARER * first) & (last > SHORT)).tolist()
    return {} if rings and _loads_move(run) else {i: float(last[i]) for i in rings}


def _loads_move(run: Run) -> bool:
    """Whether loads but gravity change in the last steps."""
    ends = [run.steps - STEPS, run.steps - 1]
    gravity = [run.simulator.generalised_force(run["q"][k], None) for k in ends]
    first, last = run.noted("tau")[ends] - gravity
    return bool(np.abs(first - last).max() > SHORT * np.abs(run.noted("tau")).max())


def _soft(run: Run, bears: bool) -> bool:
    """Whether springs are softer than the slope of their loads, where these are at rest.

    That is where the matrix K_q^-1 d(tau_a)/d(q_a), by which a step multiplies a distance from
    rest, has an eigenvalue of 1 or more. Where contacts or rows bear, it is taken between the ends.
    """
    n_a = run.system.n_a
    K_q = run.simulator.K_q
    q = run.system.integrate(run["q"][-2], run["delta_q"][-1, : run.system.n_v] / 2)

    def moved(way: Array) -> Array:
        """The state after a motion of actuated coordinates, (n_a,) [m, rad]."""
        return run.system.integrate(q, np.append(way, np.zeros(run.system.n_v - n_a)))

    def load(at: Array) -> Array:
        """Gravity on actuated coordinates, (n_a,) [N, N m]."""
        return run.simulator.generalised_force(at, None)[:n_a]

    for _ in range(1 if bears else ITERATIONS):
        ways: Array = NEARBY * np.eye(n_a)
        slope = np.array([load(moved(-way)) - load(moved(way)) for way in ways]).T / (2 * NEARBY)
        lag = run.system.actuated_difference(q, run["q_bar_a"][-1])
        if not bears:
            q = moved(np.linalg.solve(K_q + slope, load(q) + K_q @ lag).astype(float))
    return bool(np.abs(np.linalg.eigvals(np.linalg.solve(K_q, slope))).max() >= 1)


def rings(run: Run) -> Iterator[Finding]:
    """The coordinate that jumps farthest: its spring is too soft, or h too large for what hangs.

    With a spring that is stiffer than its load's slope, and nothing on it, it comes to rest.
    """
    every = ringing(run)
    if not every:
        return
    forces = [run.arrays[name] for name in ("wrench", "lam_extra") if name in run.arrays]
    bears = any(force[-2:].any() for force in forces)
    soft = _soft(run, bears)
    if not soft and not bears:
        return
    i = max(every, key=every.__getitem__)
    coordinate = run.system.coordinates[i]
    joint = run.system.joint(coordinate.joint)
    at = run["q"][-2:, joint.q][:, i - joint.v.start]
    unit = "N/m" if coordinate.unit == "m" else "N m/rad"
    K = run.simulator.K_q[i, i]
    cause = f"{coordinate.name} goes to and fro between {at.max():.4g} and {at.min():.4g} "
    cause += f"{coordinate.unit}: its spring, {K:.3g} {unit}, is "
    cause += "softer" if soft else "stiffer"
    cause += " than its load's slope"
    remedy = f"raise K_q of {joint.name}, or set gravity_compensated, or do not actuate it"
    if not soft:
        cause += f", and h = {run.h:g} s is too long for what hangs on it"
        remedy = "take a smaller h"
    yield finding("rings", cause, remedy, joint.name, jump=every[i], K_q=K)
