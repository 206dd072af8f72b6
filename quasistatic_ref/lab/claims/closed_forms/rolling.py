"""A sphere pushed at its centre, rolling on a floor that is rough enough."""

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.claims.claim import Claim, Comparison, Evidence, comparison, sum_of_terms
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.rigid import sphere_step
from quasistatic_ref.lab.scenes.systems import (
    body_text,
    on_link,
    simulator_of,
    steps_of,
    system_of,
    world_plane,
)
from quasistatic_ref.lab.thresholds import exact, grid
from quasistatic_ref.shapes.placed_shape import Sphere
from quasistatic_ref.tolerances import CLOSED_FORM

M = 0.3
INERTIA = 3e-4
RADIUS = 0.05
MU_V = 0.9
SLIPS = 1e-9
"""Least slip, over the way, of a sphere that does not roll [-]."""
STEPS = 12


def limit_of_rolling() -> Comparison:
    """Spheres at random, pushed with a little less and a little more than the rolling limit."""
    rng = np.random.default_rng(12)
    shares = np.tile([0.999, 1.001], 20)
    slips = []
    for share in shares:
        m, r, h = 10 ** rng.uniform([-2, -2, -3], [2, 0, -1])
        inertia = m * r**2 * rng.uniform(0.1, 0.66)
        mu_v = rng.uniform(0.05, 1.5)
        phi = h**2 * GRAVITY * rng.uniform(-1.0, 0.9)
        N = m * GRAVITY - m * phi / h**2
        force = share * mu_v * N * (inertia + m * r**2) / inertia
        wrench = (force, 0, -m * GRAVITY, 0, 0, 0)
        step = sphere_step(m, inertia, r, wrench, mu_v=mu_v, mu_omega=0.0, phi=phi, h=h)
        x, _, _, _, turn, _ = exact(step).delta_q
        slips.append(x - r * turn > SLIPS * x)
    return comparison("slips, beyond the limit alone [0 or 1]", slips, shares > 1, 0.0)


def evidence() -> Evidence:
    """Forces along several directions; every step against the one before it."""
    turned = []
    wanted = []
    heights = []
    dips = []
    closed = []
    ahead = []
    along = []
    for force, azimuth, h in grid([0.05, 0.3, 1.0], [0.0, 0.7, 2.5], [0.01, 0.03]):
        text = body_text(M, (INERTIA,) * 3)
        system = system_of({"ball": text}, ball={"xyz": (0.1, -0.2, RADIUS)})
        ball = on_link(system, "ball", Sphere(RADIUS))
        pair = ContactPair("floor", world_plane(), ball, MU_V, 0.0, 4, 1)
        simulator = simulator_of(system, (pair,), h)
        direction = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        q = system.q_start
        theta = h**2 * force / (M + INERTIA / RADIUS**2) / RADIUS
        sinc = np.sin(theta) / theta
        for _ in range(STEPS):
            push = system.load(q, "ball", force * direction)
            result = steps_of(simulator, 1, q=q, force=push)[0]
            phi = q[2] - RADIUS
            # exp6 of a twist that rolls by theta and rises by -phi: an arc, not a straight line.
            turned.append(np.linalg.norm(result.solution.delta_q[3:]))
            wanted.append(theta)
            heights.append(result.q[2])
            dips.append(q[2] - RADIUS * (1 - np.cos(theta)))
            closed.append(-sinc * phi)
            ahead.append(direction @ (result.q[:3] - q[:3]))
            along.append(sinc * RADIUS * theta - (1 - np.cos(theta)) / theta * phi)
            q = result.q
    rolled = np.array(wanted)
    return Evidence.of(
        comparison("turn of a step [rad]", turned, rolled, 10 * CLOSED_FORM, rolled),
        sum_of_terms("height [m]", heights, [dips, closed], CLOSED_FORM),
        comparison("way of a step [m]", ahead, along, 10 * CLOSED_FORM, RADIUS * rolled),
        limit_of_rolling(),
    )


CLAIM = Claim(
    name="rolling_sphere",
    sentence="A sphere rolls while F I / (I + m r^2) <= mu_v N: x = h^2 F / (m + I / r^2) without "
    "lift-off; the screw takes its centre along an arc, r (1 - cos theta) into the floor, and the "
    "next step pushes it out.",
    where="docs/derivations.md (R12)",
    sweep="three forces, three directions, two time steps; 12 steps each; 40 random spheres "
    "around the limit",
    reason="CLOSED_FORM; ten times that for turn and way, thousand times smaller than the "
    "coordinates from which they are taken.",
    measure=evidence,
)
