"""A block on an incline: it stays, slides without turning, or tips over its lower edge."""

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison, sum_of_terms
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.systems import (
    body_text,
    cloud_on,
    simulator_of,
    steps_of,
    system_of,
    world_plane,
)
from quasistatic_ref.lab.thresholds import grid
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.tolerances import CLOSED_FORM

M = 0.4
H = 0.01
L, WIDTH = 0.06, 0.05
"""Half the base, along and across the slope [m]."""
STEPS = 8


def block_steps(slope: float, mu_v: float, z: float, steps: int) -> list[StepResult]:
    """A block with its centre of mass z above the middle of its base, at rest on a slope."""
    inertia = (M / 3 * (WIDTH**2 + z**2), M / 3 * (L**2 + z**2), M / 3 * (L**2 + WIDTH**2))
    normal = np.array([np.sin(slope), 0.0, np.cos(slope)])
    start = {"rpy": (0.0, slope, 0.0), "xyz": tuple(z * normal)}
    system = system_of({"block": body_text(M, inertia)}, block=start)
    corners = cloud_on(system, "block", grid([-L, L], [-WIDTH, WIDTH], [-z]))
    pair = ContactPair("base", world_plane(normal), corners, mu_v, 0.0, 4, 4)
    return steps_of(simulator_of(system, (pair,), H), steps)


def displacements(results: list[StepResult]) -> Array:
    """delta_q of each step, shape (k, 6): x down the slope, z off it; the block's own axes."""
    return np.array([result.solution.delta_q for result in results])


def slide_evidence() -> Evidence:
    """Low blocks on slopes around the angle of friction."""
    stuck = []
    slips = []
    fixed = []
    left = []
    sideways = []
    k = np.arange(STEPS)
    for slope, mu, z in grid(np.radians([5, 15, 25, 35, 50]), [0.2, 0.5, 0.9], [0.01, 0.05]):
        if np.isclose(np.tan(slope), mu, rtol=1e-3):
            continue
        if np.tan(slope) < mu:
            stuck.append(displacements(block_steps(slope, mu, z, 1)) / (H**2 * GRAVITY))
            continue
        delta_q = displacements(block_steps(slope, mu, z, STEPS))
        steady = H**2 * GRAVITY * (np.sin(slope) - mu * np.cos(slope))
        slips.append(delta_q[:, 0])
        fixed.append(np.full(STEPS, steady))
        left.append(-steady * (mu**2 / (1 + mu**2)) ** (k + 1))
        sideways.append(delta_q[:, [1, 3, 4, 5]] / (H**2 * GRAVITY / L))
    return Evidence.of(
        comparison("stuck: motion, in h^2 g [-]", np.array(stuck), 0.0, CLOSED_FORM),
        sum_of_terms("slip of step k [m]", slips, [fixed, left], 4 * CLOSED_FORM),
        comparison("sliding: sideways and turns [-]", np.array(sideways), 0.0, 4 * CLOSED_FORM),
    )


def tip_evidence() -> Evidence:
    """High blocks whose friction would hold them: they tip at tan a = L / z."""
    turns = []
    up = []
    down = []
    held = []
    for z, share in grid([0.1, 0.2, 0.4], [0.9, 0.999, 1.001, 1.1, 1.4]):
        slope = np.arctan(share * L / z)
        delta_q = displacements(block_steps(slope, 1.5, z, 1))[0]
        if share < 1:
            held.append(delta_q / (H**2 * GRAVITY))
            continue
        about_edge = M / 3 * (L**2 + z**2) + M * (L**2 + z**2)
        unit = H**2 * M * GRAVITY / about_edge
        turns.append(delta_q[4])
        down.append(unit * z * np.sin(slope))
        up.append(-unit * L * np.cos(slope))
    return Evidence.of(
        comparison("held: motion, in h^2 g [-]", held, 0.0, CLOSED_FORM),
        sum_of_terms("turn about the lower edge [rad]", turns, [down, up], CLOSED_FORM),
    )


SLIDE = Claim(
    name="incline_sliding",
    sentence="A block on an incline stays while tan a <= mu_v; beyond, its slip goes to h^2 g "
    "(sin a - mu_v cos a) a step at the rate mu_v^2 / (1 + mu_v^2), and it does not turn.",
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
