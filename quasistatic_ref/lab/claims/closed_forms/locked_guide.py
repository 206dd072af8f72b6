"""A body between two walls: how far it can slide or turn in a step, whatever pushes it."""

import numpy as np

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.lab.thresholds import exact, grid
from quasistatic_ref.tolerances import CLOSED_FORM

M = 0.5
INERTIA = 2e-4
MU_V = 0.5
MU_OMEGA = 0.01
H = 0.01
WALLS = [[[1, 0, 0], [0, 0, -1], [0, 1, 0]], [[1, 0, 0], [0, 0, 1], [0, -1, 0]]]
"""Rows d1, d2, n of two walls that face each other along y."""
ACROSS = [0.0, 1.0, 0.0]


def guide_step(force: float, angle: float, phi: float) -> StepSolution:
    """One step of a point midway between the walls, with the gap phi to each [m].

    The force [N] is in their plane, at an angle [rad] from d1.
    """
    push = force * np.array([np.cos(angle), 0.0, np.sin(angle)])
    contacts = contacts_of(phi, WALLS, np.tile(np.eye(4, 3), (2, 1, 1)), MU_V)
    return exact(free_step(M * np.eye(3), push, contacts, H))


def guide_turn(torque: float, phi: float) -> float:
    """Turn about y [rad] of a body under a torque [N m], with the gap phi to each wall [m].

    It moves along y and turns about it.
    """
    J = np.zeros((2, 4, 2))
    J[:, :3, 0] = ACROSS
    J[:, 3, 1] = [1.0, -1.0]
    contacts = contacts_of(phi, WALLS, J, 0.0, MU_OMEGA, 6)
    step = free_step(np.diag([M, INERTIA]), [0.0, torque], contacts, H)
    return float(exact(step).delta_q[1])


def evidence() -> Evidence:
    """Forces from a hundredth of what reaches the limit to a million times that."""
    shares = [0.01, 0.5, 0.99, 1.01, 2.0, 1e3, 1e6]
    gaps = [0.0, 1e-5, 1e-3]
    slips = []
    expected = []
    pressed = []
    balance = []
    for share, angle, phi in grid(shares, np.radians([0.0, 20.0, 45.0, 90.0]), gaps):
        force = share * M * max(phi, 1e-5) / (MU_V * H**2)
        free = H**2 * force / M * np.array([np.cos(angle), np.sin(angle)])
        most = phi / MU_V
        answer = guide_step(force, angle, phi)
        slips.append(answer.delta_q[[0, 2]])
        expected.append(np.minimum(free, most))
        # What does not move the body, the walls bear: mu_v N along each tangent.
        pressed.append(MU_V * answer.wrench[:, 2].sum() / force)
        balance.append((M / H**2 * (free - expected[-1])).sum() / force)
    turns = []
    limits = []
    for share, phi in grid(shares, gaps):
        torque = share * INERTIA * max(phi, 1e-5) / (MU_OMEGA * H**2)
        turns.append(guide_turn(torque, phi))
        limits.append(min(H**2 * torque / INERTIA, phi / MU_OMEGA))
    scale = np.abs(expected).max(axis=1, keepdims=True) + 1e-5
    return Evidence.of(
        comparison("slip along d1 and d2 [m]", slips, expected, CLOSED_FORM, scale),
        comparison("mu_v times the load of the walls, over the force [-]", pressed, balance,
                   CLOSED_FORM, 1.0),
        comparison("turn [rad]", turns, limits, CLOSED_FORM, 1.0),
    )  # fmt: skip


CLAIM = Claim(
    name="locked_guide",
    sentence="With a gap phi to each of two walls a body moves by at most phi / mu_v a step "
    "along each tangent, sqrt 2 of that between them, and turns by at most phi / mu_omega, "
    "whatever the force; the walls bear the rest.",
    where="docs/derivations.md (R38)",
    sweep="seven forces up to a million times the limit's, four directions, three gaps",
    reason="CLOSED_FORM, relative to the larger of motion and 10 um.",
    measure=evidence,
)
