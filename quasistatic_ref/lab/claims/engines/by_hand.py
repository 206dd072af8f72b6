"""A quasi-dynamic simulator of one scene, written by hand: NumPy and qpsolvers, nothing of ours.

A finger on a rail pushes a sphere along a floor, with torsion at both contacts.
"""

import numpy as np
from qpsolvers import solve_qp
from scipy.sparse import csc_matrix

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.lab.scenes.contacts import GRAVITY
from quasistatic_ref.lab.scenes.systems import (
    RAIL,
    body_text,
    on_link,
    simulator_of,
    system_of,
    world_plane,
)
from quasistatic_ref.shapes.placed_shape import Box, Sphere
from quasistatic_ref.step.data import Array

M, INERTIA, RADIUS, H, STIFFNESS, SPEED, STEPS = 0.3, 3e-4, 0.05, 0.01, 500.0, 0.03, 60
FLOOR, FINGER = (0.3, 0.004), (0.6, 0.01)
"""(mu_v, mu_omega) of the two contacts."""

START = np.array([RADIUS + 0.002, 0.01, RADIUS])
"""Centre of the sphere; the face of the finger starts at x = 0 [m]."""

TORQUE = np.array([0.0, 0.0, 0.02])
"""On the sphere, about the vertical, so that it spins as well [N m]."""

UNIT = np.array([1e-4, 1e-4, 1e-4, 1e-4, 2e-3, 2e-3, 2e-3])
"""What the unknowns are divided by before qpsolvers sees them [m, rad]."""

QP_TOLERANCE = 1e-9
"""Of positions after 60 steps, over the way: Clarabel's accuracy is 1e-11 in these units, and the
errors of single steps add up; measured 5e-13."""


def skew(r: Array) -> Array:
    """The matrix of r x, shape (3, 3)."""
    return np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0.0]])


def hand_step(finger: float, p: Array, R: Array, target: float) -> Array:
    """Displacement of the finger and twist of the sphere, shape (7,), assembled and solved by hand.

    Parameters
    ----------
    finger, target : float
        Position of the finger, and where it is to go [m].
    p : ndarray, shape (3,)
        Centre of the sphere [m].
    R : ndarray, shape (3, 3)
    """
    rows, gaps = [], []
    contacts = (
        (np.array([0, 0, 1.0]), p[2] - RADIUS, 0.0, FLOOR),
        (np.array([1.0, 0, 0]), p[0] - RADIUS - finger, 1.0, FINGER),
    )
    for n, phi, pushed, (mu_v, mu_omega) in contacts:
        arm = skew(-RADIUS * n)
        point = np.column_stack(
            [-pushed * np.array([1.0, 0, 0]), R, -arm @ R]
        )  # of beta from alpha
        spin = np.concatenate([np.zeros(4), n @ R])
        tangents = [t for t in np.eye(3) if t @ n == 0]
        for t in tangents:
            rows += [(n + mu_v * t) @ point, (n - mu_v * t) @ point]
        rows += [n @ point + mu_omega * spin, n @ point - mu_omega * spin]
        gaps += [phi] * 6
    P = np.diag([H * STIFFNESS, *[M / H] * 3, *[INERTIA / H] * 3])
    force = np.concatenate([R.T @ np.array([0, 0, -M * GRAVITY]), R.T @ TORQUE])
    q = -H * np.concatenate([[STIFFNESS * (target - finger)], force])
    energy = 1e-6  # joule seconds: brings P and q in these units near one
    x = solve_qp(
        csc_matrix(P * np.outer(UNIT, UNIT) / energy), q * UNIT / energy,
        csc_matrix(-np.array(rows) * UNIT / UNIT[0]), np.array(gaps) / UNIT[0],
        solver="clarabel", tol_feas=1e-11, tol_gap_abs=1e-13, tol_gap_rel=1e-13,
    )  # fmt: skip
    return np.full(7, np.nan) if x is None else x * UNIT


def moved(p: Array, R: Array, twist: Array) -> tuple[Array, Array]:
    """The pose p (3,) [m] and R (3, 3) after a `twist` (6,) [m, rad], by Rodrigues' formula."""
    v, w = twist[:3], twist[3:]
    angle, W = float(np.linalg.norm(w)), skew(w)
    if angle == 0:
        return p + R @ v, R
    turn = np.eye(3) + np.sin(angle) / angle * W + (1 - np.cos(angle)) / angle**2 * W @ W
    left = np.eye(3) + (1 - np.cos(angle)) / angle**2 * W
    left = left + (angle - np.sin(angle)) / angle**3 * W @ W
    return p + R @ (left @ v), R @ turn


def by_hand() -> Array:
    """Finger, centre and rotation matrix after each step, shape (STEPS, 13)."""
    finger, p, R, states = 0.0, START, np.eye(3), []
    for k in range(STEPS):
        x = hand_step(finger, p, R, SPEED * H * (k + 1))
        finger, (p, R) = finger + float(x[0]), moved(p, R, x[1:])
        states.append(np.concatenate([[finger], p, R.ravel()]))
    return np.array(states)


def by_us() -> Array:
    """The same from a URDF, through System and Simulator, shape (STEPS, 13)."""
    system = system_of(
        {"rail": RAIL, "ball": body_text(M, (INERTIA,) * 3)},
        rail={"base": "fixed", "actuated": "all", "xyz": (-0.01, 0.0, RADIUS)},
        ball={"xyz": tuple(START)},
    )
    tip = on_link(system, "rail/finger", Box(np.array([0.01, 0.2, 0.2])))
    sphere = on_link(system, "ball", Sphere(RADIUS))
    pairs = (
        ContactPair("floor", world_plane(), sphere, *FLOOR, 6, 1),
        ContactPair("finger", tip, sphere, *FINGER, 6, 1),
    )
    simulator = simulator_of(system, pairs, H, [[STIFFNESS]])
    q, states, link = system.q_start, [], system.link("ball")
    for k in range(STEPS):
        torque = system.centre_of_mass_force(q, "ball", np.zeros(3), TORQUE)
        result = simulator.step(q, np.array([SPEED * H * (k + 1)]), torque)
        q = result.q
        pose = system.kinematics(q)
        states.append(np.concatenate([q[:1], pose.t[link], pose.R[link].ravel()]))
    return np.array(states)


def evidence() -> Evidence:
    """Sixty steps from touching nothing to rolling, sliding and spinning."""
    hand, ours = by_hand(), by_us()
    way = np.linalg.norm(ours[-1, 1:4] - START)
    return Evidence.of(
        comparison(
            "finger and centre of the sphere [m]", ours[:, :4], hand[:, :4], QP_TOLERANCE, way
        ),
        comparison("rotation matrix [-]", ours[:, 4:], hand[:, 4:], QP_TOLERANCE),
    )


CLAIM = Claim(
    name="by_hand",
    sentence="A simulator of one scene, assembled by hand in NumPy without any robotics stack and "
    "solved through qpsolvers, goes the same way.",
    where="the paper, Eqs. (2)-(8), (13)",
    sweep="a finger pushes a sphere that is also spun by a torque, 60 steps",
    reason="QP_TOLERANCE, relative to the way of the sphere.",
    measure=evidence,
    engine="qpsolvers",
    setting="solver clarabel, tol_feas 1e-11, tol_gap_abs and tol_gap_rel 1e-13",
)
