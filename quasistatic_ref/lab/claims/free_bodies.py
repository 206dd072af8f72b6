"""Bodies without friction: free fall, an approach, and what the time step is worth as inertia."""

import numpy as np

from quasistatic_ref.certify.failures import StepInfeasible
from quasistatic_ref.lab.claims.claim import Claim, Comparison, comparison, sum_of_terms
from quasistatic_ref.lab.made_steps.at_random import random_contacts, random_step
from quasistatic_ref.lab.made_steps.contacts import GRAVITY
from quasistatic_ref.lab.made_steps.rigid import point_step
from quasistatic_ref.lab.made_steps.systems import body_text, simulator_of, steps_of, system_of
from quasistatic_ref.lab.thresholds import exact, grid
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.tolerances import CLOSED_FORM

# Free fall, and a point that approaches the floor or has sunk into it.

FALL_STEPS = 10


def fall_evidence() -> list[Comparison]:
    """Heights of random bodies that fall for ten steps, against -k h^2 g."""
    rng = np.random.default_rng(2)
    heights = []
    expected = []
    sideways = []
    turned = []
    for h in (1e-3, 1e-2, 1e-1):
        for _ in range(4):
            com = rng.uniform(-0.1, 0.1, 3)
            rpy = tuple(rng.uniform(-1.5, 1.5, 3))
            text = body_text(float(rng.uniform(0.1, 5)), (0.02, 0.03, 0.04), com=com)
            system = system_of({"body": text}, body={"rpy": rpy})
            results = steps_of(simulator_of(system, (), h), FALL_STEPS)
            q = np.array([r.q for r in results])
            heights.append(q[:, 2])
            expected.append(-np.arange(1, FALL_STEPS + 1) * h**2 * GRAVITY)
            sideways.append(q[:, :2] / (h**2 * GRAVITY))
            turned.append((q[:, 3:] - system.q_start[3:]) / (h**2 * GRAVITY / 0.1))
    fallen = np.array(expected)
    return [
        comparison("height after k steps [m]", heights, fallen, CLOSED_FORM, fallen),
        comparison(
            "sideways, in steps of fall [-]", np.array(sideways), 0.0, FALL_STEPS * CLOSED_FORM
        ),
        comparison("turned, in steps of fall [-]", np.array(turned), 0.0, FALL_STEPS * CLOSED_FORM),
    ]


def approach_evidence() -> list[Comparison]:
    """Rises of a point mass that starts at gaps from -1 mm to 1 cm, against a formula."""
    gaps = [-1e-3, -1e-5, -1e-8, 0.0, 1e-8, 1e-5, 9e-4, 1e-3, 1e-2]
    sweep = grid([0.01, 0.3, 100.0], gaps, [1e-3, 1e-2, 1e-1])
    answers = [exact(point_step(m, (0, 0, -GRAVITY * m), 0.5, phi, h)) for m, phi, h in sweep]
    m, phi, h = sweep.T
    rises = np.array([answer.delta_q[2] for answer in answers])
    forces = np.array([answer.wrench[0, 2] for answer in answers])
    weight = m * GRAVITY
    push = -m * phi / h**2
    bears = weight + push > 0
    return [
        comparison(
            "rise [m]", rises, np.maximum(-(h**2) * GRAVITY, -phi), CLOSED_FORM, h**2 * GRAVITY
        ),
        sum_of_terms("N [N]", forces, [weight * bears, push * bears], CLOSED_FORM),
    ]


FALL = Claim(
    name="free_fall",
    sentence="A free body falls by h^2 g in every step, without acceleration and without turning, "
    "wherever its centre of mass is.",
    where="docs/derivations.md (R3)",
    sweep="12 bodies: masses, centres of mass and orientations at random, three time steps, ten "
    "steps",
    reason="CLOSED_FORM, of the height fallen, and for each of the steps.",
    measure=fall_evidence,
)

APPROACH = Claim(
    name="approach",
    sentence="A body above the floor closes its gap in one step if its weight moves it so far. A "
    "body in the floor is pushed out in one step, by N = m g - m phi / h^2.",
    where="docs/derivations.md (R4)",
    sweep="three masses, nine gaps from -1 mm to 1 cm, three time steps",
    reason="CLOSED_FORM, relative to the larger of weight and push.",
    measure=approach_evidence,
)

# Inertia and time step are one number: a smaller step is a heavier body.

RANDOM_STEPS = 40


def evidence() -> list[Comparison]:
    """Random steps with k times the inertia, against the same with h / sqrt(k)."""
    rng = np.random.default_rng(45)
    heavier: list[Array] = []
    shorter: list[Array] = []
    forces: list[Array] = []
    expected: list[Array] = []
    while len(heavier) < RANDOM_STEPS:
        step = random_step(rng, 2, 4, random_contacts(rng, 3, 6))
        k = 4.0 ** float(rng.integers(-3, 4))  # its root is a power of two: nothing is rounded
        try:
            heavy = exact(step.replace(M_u=k * step.M_u))
            short = exact(step.replace(h=step.h / np.sqrt(k)))
        except StepInfeasible:
            continue
        heavier.append(heavy.delta_q)
        shorter.append(short.delta_q)
        forces.append(heavy.wrench)
        expected.append(short.wrench)
    return [
        comparison("delta_q with k M_u at h [m, rad]", heavier, shorter, 0.0),
        comparison("forces of the contacts [N, N m]", forces, expected, 0.0),
    ]


CLAIM = Claim(
    name="inertia_and_time_step",
    sentence="If targets, loads and contacts are the same, a step with the inertia k M_u at h "
    "and a step with M_u at h / sqrt(k) have the same displacement and forces: smaller "
    "steps act like heavier bodies, and as h goes to 0 every free body becomes a wall.",
    where="docs/artifacts.md (R45)",
    sweep=f"{RANDOM_STEPS} random steps with a solution, k from 1/64 to 64",
    reason="no tolerance: sqrt(k) is a power of two, so the bits are the same.",
    measure=evidence,
)
