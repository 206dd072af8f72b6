"""Things that a finger pushes: a block at some speed, and a slider on a plane."""

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.claims.claim import Claim, Comparison, comparison, sum_of_terms, within
from quasistatic_ref.lab.made_steps.contacts import GRAVITY
from quasistatic_ref.lab.made_steps.slider import (
    GYRATION,
    RADII,
    SPEEDS,
    STIFFNESS,
    push,
    push_step,
    rotated,
    turns,
)
from quasistatic_ref.lab.made_steps.systems import (
    RAIL,
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
from quasistatic_ref.shapes.placed_shape import Box, Sphere
from quasistatic_ref.tolerances import CLOSED_FORM

# A block pushed along the floor by a finger of some stiffness: lag, gap and drag.

M = 0.2
L = 0.06
C = 0.03
BLOCK_STIFFNESS = 2e4
STEPS = 40
"""After these the transient, at most 0.3 of what it was in each step, is below rounding."""

BLOCK = body_text(M, (2e-4, 3e-4, 4e-4))


def steady_push(v: float, mu_v: float, h: float) -> Array:
    """Simulate a push: lag of the finger, largest and least gap of the block [m], its load [N].

    Returns
    -------
    ndarray, shape (4,)
    """
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
    simulator = simulator_of(system, pairs, h, [[BLOCK_STIFFNESS]])
    last = steps_of(simulator, STEPS, velocity=[v])[-1]
    lag = STEPS * h * v - last.q[0]
    load = last.solution.wrench[1:, 2].sum()
    return np.array([lag, last.points.phi[1:].max(), last.points.phi[1:].min(), load])


def pushed_block_evidence() -> list[Comparison]:
    """A pushed block's lag, gaps and load, against (R13), at several speeds, mu_v and h."""
    sweep = grid([0.005, 0.05, 0.2], [0.2, 0.5], [5e-3, 1e-2])
    v, mu, h = sweep.T
    measured = np.array([steady_push(*x) for x in sweep])
    friction = mu * M * GRAVITY
    drag = M * v / h
    force = BLOCK_STIFFNESS * measured[:, 0]
    gap = measured[:, 1:3]
    ride = np.repeat((mu * v * h)[:, None], 2, axis=1)
    load = measured[:, 3]
    weight = M * GRAVITY
    return [
        sum_of_terms("K times the finger's lag [N]", force, [friction, drag], CLOSED_FORM),
        comparison("gap under the block [m]", gap, ride, CLOSED_FORM, C),
        comparison("load of the base [N]", load, weight, 10 * CLOSED_FORM, weight),
    ]


PUSHED_BLOCK = Claim(
    name="pushed_block",
    sentence="A block that is pushed at the speed v resists with mu_v m g + m v / h, and floats at "
    "a gap of mu_v v h. No real block feels the drag m v / h.",
    where="docs/derivations.md (R13)",
    sweep="three speeds, two mu_v, two time steps; the steady state after 40 steps",
    reason="CLOSED_FORM, of the larger of friction and drag, and of the height from which gaps "
    "are taken; ten times that for the load, which is inertia over h^2 times rounded gaps.",
    measure=pushed_block_evidence,
)

# A slider pushed on the plane under an ellipsoidal limit surface, slowly and less slowly.
#
# (R28): with D = diag(1, 1, chi^2) and xi = (dx, dy, dtheta), the constraint of a slider that slips
# is tight, phi + dz = mu_v ||xi||_D = s. On it act N = m g + m dz / h^2 and, along the gradient of
# the limit surface, -N mu_v D xi / ||xi||_D. The balance M xi / h^2 + N mu_v^2 D xi / s = (F, r x
# F) has F along v and gives the law. A sticking pusher moves the touched point by u = v + omega
# r_perp with omega = r_perp . v / chi'^2, that is u = (1 + r_perp r_perp' / chi'^2) v, which is
# inverted by v = (chi'^2 + r r') u / (chi'^2 + |r|^2), since r r' + r_perp r_perp' = |r|^2. A
# pusher without friction, of normal n and arm t = r x n, that advances by u gives v = u n / (1 +
# t^2 / chi'^2) and omega = t v / chi'^2.

ENCLOSED = 1e-15
"""Largest error_bound: below the rounding of data and formulas that CLOSED_FORM is made for."""

PUSHES = 64


def planar_push_evidence() -> list[Comparison]:
    """Motions of a slider pushed at random, against (R28)."""
    rng = np.random.default_rng(28)
    # The angle of the point, its radius, the angle aside, mu_v, chi, Pi; lifted and sticks or not.
    lowest = [0.0, 0.005, -1.2, 0.1, 0.01, 0.01]
    highest = [2 * np.pi, 0.06, 1.2, 0.8, 0.05, 0.5]
    sizes = rng.uniform(lowest, highest, size=(PUSHES, 6))
    sweep = np.column_stack([sizes, rng.integers(0, 2, size=(PUSHES, 2))])
    pushes = [
        push(
            rotated(np.array([radius, 0.0]), angle), rotated(np.array([-1.0, 0.0]), angle + aside),
            mu_v=mu_v, chi=chi, Pi=Pi, lifted=lifted, sticks=bool(sticks),
        )
        for angle, radius, aside, mu_v, chi, Pi, lifted, sticks in sweep
    ]  # fmt: skip
    answers = [exact(push_step(of)) for of in pushes]
    chi = sweep[:, 4]
    # Turns and torques as lengths and forces at the radius chi.
    moved = np.array([a.delta_q[[2, 3, 5]] for a in answers])
    moved[:, 2] *= chi
    expected = np.array([of.motion for of in pushes])
    expected[:, 2] *= chi
    size = np.linalg.norm(expected, axis=1)
    support = np.array([a.wrench[0, [0, 1, 3]] for a in answers])
    support[:, 2] /= chi
    normal = np.array([of.friction for of in pushes])
    normal[:, 2] /= chi
    load = np.array([of.load for of in pushes])
    rise = np.array([of.rise for of in pushes])
    gap = sweep[:, 3] * size
    bounds = np.array([a.certificate.error_bound for a in answers], dtype=np.float64)
    # The push is what the pusher's spring says.
    spring = np.array([
        STIFFNESS * (step.delta_q_bar_a - a.delta_q[:2])
        for step, a in zip(map(push_step, pushes), answers, strict=True)
    ])  # fmt: skip
    force = np.array([of.force for of in pushes])
    total = np.linalg.norm(force, axis=1)
    law = [(1 + SPEEDS) / (1 + SPEEDS * (GYRATION / chi) ** 2) for chi in RADII]
    along_normal = "support's force, along the normal of its limit surface [N]"
    return [
        comparison("motion of the slider [m]", moved, expected, CLOSED_FORM, size[:, None]),
        comparison("rise [m]", [a.delta_q[4] for a in answers], rise, CLOSED_FORM, gap),
        comparison(along_normal, support, normal, CLOSED_FORM, load[:, None]),
        comparison("push [N]", spring, force, CLOSED_FORM, total[:, None]),
        comparison("load [N]", [a.wrench[0, 2] for a in answers], load, CLOSED_FORM, load),
        comparison("turn over Lynch's [-]", [turns(chi) for chi in RADII], law, CLOSED_FORM, law),
        within("error_bound [-]", bounds, 0.0, ENCLOSED),
    ]


PLANAR_PUSH = Claim(
    name="planar_push",
    sentence="A slider pushed on the plane moves along the normal of its ellipsoidal limit "
    "surface: as Lynch, Maekawa and Tanie say while the quasi-dynamic number Pi is small, and at "
    "any Pi with their chi^2 replaced by (chi^2 + Pi rho^2) / (1 + Pi).",
    where="docs/derivations.md (R28), in the ellipsoid; Lynch, Maekawa & Tanie (1992)",
    sweep=f"{PUSHES} random points, directions, mu_v, mu_omega / mu_v and Pi, from the floor or in "
    "steady motion, with a pusher that sticks or one without friction; turns at nine Pi for "
    "three mu_omega / mu_v",
    reason="CLOSED_FORM; ENCLOSED: what is proved of the answers has to be finer than that.",
    measure=planar_push_evidence,
)
