"""Actuated coordinates: free, and pressed against a wall."""

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Comparison, comparison, sum_of_terms
from quasistatic_ref.lab.made_steps.contacts import contacts_of, no_contacts
from quasistatic_ref.lab.made_steps.rigid import actuated_step
from quasistatic_ref.lab.thresholds import exact, grid
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import CLOSED_FORM


def free_evidence() -> list[Comparison]:
    """Displacements of 1 to 7 springs without contacts, of random K_q, against target and sag."""
    rng = np.random.default_rng(1)
    moved = []
    wanted = []
    sagged = []
    for n_a in range(1, 8):
        for _ in range(4):
            B = rng.normal(size=(n_a, n_a))
            K_q = 500 * (B @ B.T / n_a + np.eye(n_a))
            tau_a = rng.normal(size=n_a)
            target = 1e-3 * rng.normal(size=n_a)
            h = float(rng.choice([1e-3, 1e-2, 1e-1]))
            step = actuated_step(K_q, tau_a, target, no_contacts(n_a), h)
            moved.append(exact(step).delta_q)
            wanted.append(target)
            sagged.append(np.linalg.solve(step.K_q, tau_a))
    terms = [np.concatenate(wanted), np.concatenate(sagged)]
    return [sum_of_terms("delta_q_a [m]", np.concatenate(moved), terms, CLOSED_FORM)]


def pressed_step(K: float, phi: float, beyond: float, tau: float) -> StepData:
    """A finger of stiffness K whose target lies `beyond` [m] a wall at the gap phi."""
    J = np.zeros((1, 4, 1))
    J[0, 0, 0] = -1.0  # towards the wall, along -n
    frame = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
    return actuated_step([[K]], [tau], [phi + beyond], contacts_of(phi, frame, J, 0.5), 0.01)


def pressed_evidence() -> list[Comparison]:
    """Motion and force of a finger whose target lies before, at or behind a wall."""
    sweep = grid([10, 1e3, 1e5], [0, 1e-4, 2e-3], [-1e-3, 0, 1e-3], [0, 0.7])
    K, phi, beyond, tau = sweep.T
    answers = [exact(pressed_step(*of)) for of in sweep]
    moved = [answer.delta_q[0] for answer in answers]
    pressed = [answer.wrench[0, 2] for answer in answers]
    load = K * beyond + tau
    gap = phi + np.minimum(load, 0.0) / K
    size = np.maximum(abs(K * beyond), tau)
    return [
        comparison("delta_q_a [m]", moved, gap, CLOSED_FORM, scale=1e-3),
        comparison("normal force [N]", pressed, np.maximum(load, 0.0), CLOSED_FORM, scale=size),
    ]


FREE = Claim(
    name="free_impedance",
    sentence="Without contact an actuated coordinate reaches its target, displaced by the load "
    "over the stiffness.",
    where="docs/derivations.md (R1)",
    sweep="1 to 7 coordinates, 28 random stiffnesses, three time steps",
    reason="CLOSED_FORM: relative to the larger of target and sag.",
    measure=free_evidence,
)

PRESSED = Claim(
    name="pressed_impedance",
    sentence="An actuated coordinate whose target is behind a wall presses on the wall with K "
    "times the depth of the target in it.",
    where="docs/derivations.md (R2)",
    sweep="K from 10 to 1e5 N/m, gaps of 0 to 2 mm, targets in front of, at and in the wall, loads",
    reason="CLOSED_FORM; the depth is a difference of a target and a gap, rounded before the step "
    "is made.",
    measure=pressed_evidence,
)
