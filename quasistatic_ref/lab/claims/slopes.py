"""Bodies on a slope: a block that slides or tips, and a sphere that rolls."""

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.claims.claim import Claim, Comparison, comparison, sum_of_terms
from quasistatic_ref.lab.made_steps.contacts import GRAVITY
from quasistatic_ref.lab.made_steps.rigid import sphere_step
from quasistatic_ref.lab.made_steps.systems import (
    body_text,
    cloud_on,
    on_link,
    simulator_of,
    steps_of,
    system_of,
    world_plane,
)
from quasistatic_ref.lab.thresholds import exact, grid
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.placed_shape import Sphere
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.tolerances import CLOSED_FORM

# A block on an incline: it stays, slides without turning, or tips over its lower edge.

BLOCK_M = 0.4
H = 0.01
L, WIDTH = 0.06, 0.05
"""Half the base, along and across the slope [m]."""
BLOCK_STEPS = 8


def block_steps(slope: float, mu_v: float, z: float, steps: int) -> list[StepResult]:
    """A block with its centre of mass z above the middle of its base, at rest on a slope."""
    inertia = (
        BLOCK_M / 3 * (WIDTH**2 + z**2),
        BLOCK_M / 3 * (L**2 + z**2),
        BLOCK_M / 3 * (L**2 + WIDTH**2),
    )
    normal = np.array([np.sin(slope), 0.0, np.cos(slope)])
    start = {"rpy": (0.0, slope, 0.0), "xyz": tuple(z * normal)}
    system = system_of({"block": body_text(BLOCK_M, inertia)}, block=start)
    corners = cloud_on(system, "block", grid([-L, L], [-WIDTH, WIDTH], [-z]))
    pair = ContactPair("base", world_plane(normal), corners, mu_v, 0.0, 4, 4)
    return steps_of(simulator_of(system, (pair,), H), steps)


def displacements(results: list[StepResult]) -> Array:
    """delta_q of each step, shape (k, 6): x down the slope, z off it; the block's own axes."""
    return np.array([result.solution.delta_q for result in results])


def slide_evidence() -> list[Comparison]:
    """Slips of low blocks that rest or slide on slopes, step by step, against a formula."""
    sweep = grid(np.radians([5, 15, 25, 35, 50]), [0.2, 0.5, 0.9], [0.01, 0.05])
    over = np.tan(sweep[:, 0]) / sweep[:, 1]
    stuck = [displacements(block_steps(a, mu, z, 1)) for a, mu, z in sweep[over < 1 - 1e-3]]
    sliding = sweep[over > 1 + 1e-3]
    blocks = (block_steps(a, mu, z, BLOCK_STEPS) for a, mu, z in sliding)
    delta_q = np.array([displacements(steps) for steps in blocks])
    slope, mu, _ = sliding.T[:, :, None]
    steady = H**2 * GRAVITY * (np.sin(slope) - mu * np.cos(slope))
    left = -steady * (mu**2 / (1 + mu**2)) ** np.arange(1, BLOCK_STEPS + 1)
    fall = H**2 * GRAVITY
    sideways = delta_q[:, :, [1, 3, 4, 5]] / (fall / L)
    return [
        comparison("stuck: motion, in h^2 g [-]", np.array(stuck) / fall, 0.0, CLOSED_FORM),
        sum_of_terms("slip of step k [m]", delta_q[:, :, 0], [steady, left], 4 * CLOSED_FORM),
        comparison("sliding: sideways and turns [-]", sideways, 0.0, 4 * CLOSED_FORM),
    ]


def tip_evidence() -> list[Comparison]:
    """High blocks whose friction would hold them: they tip at tan a = L / z."""
    z, share = grid([0.1, 0.2, 0.4], [0.9, 0.999, 1.001, 1.1, 1.4]).T
    slope = np.arctan(share * L / z)
    blocks = zip(slope, z, strict=True)
    delta_q = np.array([displacements(block_steps(a, 1.5, of, 1))[0] for a, of in blocks])
    tips = share > 1
    about_edge = BLOCK_M / 3 * (L**2 + z**2) + BLOCK_M * (L**2 + z**2)
    unit = H**2 * BLOCK_M * GRAVITY / about_edge
    terms = [(unit * z * np.sin(slope))[tips], (-unit * L * np.cos(slope))[tips]]
    held = delta_q[~tips] / (H**2 * GRAVITY)
    return [
        comparison("held: motion, in h^2 g [-]", held, 0.0, CLOSED_FORM),
        sum_of_terms("turn about the lower edge [rad]", delta_q[tips, 4], terms, CLOSED_FORM),
    ]


SLIDE = Claim(
    name="incline_sliding",
    sentence="A block on an incline of slope a stays while tan a <= mu_v. On a steeper one it "
    "slides without turning, and its slip in a step tends to h^2 g (sin a - mu_v cos a), at the "
    "rate mu_v^2 / (1 + mu_v^2).",
    where="docs/derivations.md (R10)",
    sweep="five slopes, three mu_v, two heights of the centre of mass; eight steps each",
    reason="4 CLOSED_FORM: gaps are differences of world coordinates a thousand times larger.",
    measure=slide_evidence,
)

TIP = Claim(
    name="incline_tipping",
    sentence="A block that friction holds tips over its lower edge when tan a > L / z, by h^2 m g "
    "(z sin a - L cos a) / (I + m (L^2 + z^2)) in the first step.",
    where="docs/derivations.md (R11)",
    sweep="three heights of the centre of mass, five slopes from 0.9 to 1.4 times the limit",
    reason="CLOSED_FORM, relative to the larger of the two torques.",
    measure=tip_evidence,
)

# A sphere pushed at its centre, rolling on a floor that is rough enough.

BALL_M = 0.3
INERTIA = 3e-4
RADIUS = 0.05
MU_V = 0.9
SLIPS = 1e-9
"""Least slip, over the way, of a sphere that does not roll [-]."""
BALL_STEPS = 12


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


def evidence() -> list[Comparison]:
    """A sphere rolled by forces in several directions: turn, height and way of each step."""
    points = []
    for force, azimuth, h in grid([0.05, 0.3, 1.0], [0.0, 0.7, 2.5], [0.01, 0.03]):
        text = body_text(BALL_M, (INERTIA,) * 3)
        system = system_of({"ball": text}, ball={"xyz": (0.1, -0.2, RADIUS)})
        ball = on_link(system, "ball", Sphere(RADIUS))
        pair = ContactPair("floor", world_plane(), ball, MU_V, 0.0, 4, 1)
        simulator = simulator_of(system, (pair,), h)
        direction = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        q = system.q_start
        theta = h**2 * force / (BALL_M + INERTIA / RADIUS**2) / RADIUS
        for _ in range(BALL_STEPS):
            push = system.load(q, "ball", force * direction)
            result = steps_of(simulator, 1, q=q, force=push)[0]
            turned = np.linalg.norm(result.solution.delta_q[3:])
            ahead = direction @ (result.q[:3] - q[:3])
            points.append((theta, turned, q[2], result.q[2], ahead))
            q = result.q
    rolled, turn, before, after, way = np.array(points).T
    phi = before - RADIUS
    # exp6 of a twist that rolls by theta and rises by -phi: an arc, not a straight line.
    sinc = np.sin(rolled) / rolled
    dip = RADIUS * (1 - np.cos(rolled))
    along = sinc * RADIUS * rolled - dip / RADIUS / rolled * phi
    return [
        comparison("turn of a step [rad]", turn, rolled, 10 * CLOSED_FORM, rolled),
        sum_of_terms("height [m]", after, [before - dip, -sinc * phi], CLOSED_FORM),
        comparison("way of a step [m]", way, along, 10 * CLOSED_FORM, RADIUS * rolled),
        limit_of_rolling(),
    ]


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
