"""A block pushed along the floor by a finger of some stiffness: lag, gap and drag."""

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison, sum_of_terms
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.systems import (
    RAIL,
    body_text,
    cloud_on,
    on_link,
    simulator_of,
    steps_of,
    system_of,
    world_plane,
)
from quasistatic_ref.lab.thresholds import grid
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.placed_shape import Box, Sphere
from quasistatic_ref.tolerances import CLOSED_FORM

M = 0.2
L = 0.06
C = 0.03
STIFFNESS = 2e4
STEPS = 40
"""After these the transient, at most 0.3 of what it was in each step, is below rounding."""

BLOCK = body_text(M, (2e-4, 3e-4, 4e-4))


def steady_push(v: float, mu_v: float, h: float) -> Array:
    """Steady lag of the finger, largest and least gap [m], load of the base [N], shape (4,)."""
    start = {"xyz": (L, 0.0, C)}
    rail = {"base": "fixed", "actuated": "all", "xyz": (-0.005, 0.0, C)}
    system = system_of({"finger": RAIL, "block": BLOCK}, finger=rail, block=start)
    middle = system.q_start[system.n_q_a]
    tip = on_link(system, "finger/finger", Box((0.005, 0.02, 0.02)))
    # The finger's face starts at x = 0 and touches a ball about the block's centre.
    ball = on_link(system, "block", Sphere(middle))
    corners = cloud_on(system, "block", grid([-L, L], [-L, L], [-C]))
    pairs = (
        ContactPair("push", tip, ball, 0.0, 0.0, 4, 1),
        ContactPair("base", world_plane(), corners, mu_v, 0.0, 4, 4),
    )
    simulator = simulator_of(system, pairs, h, [[STIFFNESS]])
    last = steps_of(simulator, STEPS, velocity=[v])[-1]
    lag = STEPS * h * v - last.q[0]
    load = last.solution.wrench[1:, 2].sum()
    return np.array([lag, last.points.phi[1:].max(), last.points.phi[1:].min(), load])


def evidence() -> Evidence:
    """Speeds, friction and time steps."""
    sweep = grid([0.005, 0.05, 0.2], [0.2, 0.5], [5e-3, 1e-2])
    v, mu, h = sweep.T
    measured = np.array([steady_push(*x) for x in sweep])
    friction = mu * M * GRAVITY
    drag = M * v / h
    force = STIFFNESS * measured[:, 0]
    gap = measured[:, 1:3]
    ride = np.repeat((mu * v * h)[:, None], 2, axis=1)
    load = measured[:, 3]
    weight = M * GRAVITY
    return Evidence.of(
        sum_of_terms("K times the finger's lag [N]", force, [friction, drag], CLOSED_FORM),
        comparison("gap under the block [m]", gap, ride, CLOSED_FORM, C),
        comparison("load of the base [N]", load, weight, 10 * CLOSED_FORM, weight),
    )


CLAIM = Claim(
    name="pushed_block",
    sentence="A block pushed at the speed v resists with mu_v m g + m v / h, of which m v / h is "
    "spurious, and rides on a gap of mu_v v h.",
    where="docs/derivations.md (R13)",
    sweep="three speeds, two mu_v, two time steps; the steady state after 40 steps",
    reason="CLOSED_FORM, of the larger of friction and drag, and of the height from which gaps "
    "are taken; ten times that for the load, which is inertia over h^2 times rounded gaps.",
    measure=evidence,
)
