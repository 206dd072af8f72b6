"""The loop that people write first: points, rows and solver, step by step, in plain NumPy.

It takes poses and Jacobians from :class:`~quasistatic_ref.model.system.System`, as it would from
pinocchio, measures all points, and builds a new quadratic program for qpsolvers at each step.
"""

import numpy as np
from qpsolvers import solve_qp

from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.step.data import Array


def hand_rows(scenario: Scenario, kinematics: Kinematics) -> tuple[Array, Array]:
    """A and b of the k closest points of each pair, alpha being a solid and beta a cloud.

    Returns
    -------
    ndarray, shape (m, n_v), and ndarray, shape (m,)

    Raises
    ------
    TypeError
        If a beta is no cloud.
    """
    rows, gaps = [], []
    for pair in scenario.pairs:
        a, b = pair.alpha.link, pair.beta.link
        cloud = pair.beta.shape
        if not isinstance(cloud, PointCloud):
            raise TypeError(f"{pair.name}: beta must be a cloud")
        R_a, t_a = kinematics.R[a] @ pair.alpha.R, kinematics.R[a] @ pair.alpha.t + kinematics.t[a]
        world = cloud.points @ kinematics.R[b].T + kinematics.t[b]
        phi, normals = pair.alpha.shape.signed_distance((world - t_a) @ R_a)
        for i in np.argsort(phi, kind="stable")[: pair.k]:
            n, beta = R_a @ normals[i], world[i]
            alpha = beta - phi[i] * n
            J_a, J_b = kinematics.J[a], kinematics.J[b]
            nu = J_b[:3] - np.cross(beta - kinematics.t[b], J_b[3:], axisb=0).T
            nu = nu - J_a[:3] + np.cross(alpha - kinematics.t[a], J_a[3:], axisb=0).T
            spin = n @ (J_b[3:] - J_a[3:])
            d1 = np.eye(3)[np.abs(n).argmin()]
            d1 = d1 - (d1 @ n) * n
            d1 /= np.linalg.norm(d1)
            for d in (d1, np.cross(n, d1), -d1, -np.cross(n, d1)):
                rows.append((n + pair.mu_v * d) @ nu)
            if pair.rows == 6:
                rows += [n @ nu + pair.mu_omega * spin, n @ nu - pair.mu_omega * spin]
            gaps += [phi[i]] * pair.rows
    return np.array(rows), -np.array(gaps)


def hand_step(scenario: Scenario, q: Array, q_bar_a: Array) -> Array:
    """delta_q of one step, of a scenario without wrenches whose joints are compensated.

    Returns
    -------
    ndarray, shape (n_v,)
        [m, rad].

    Raises
    ------
    RuntimeError
        If the solver finds nothing.
    """
    system, h, n_a = scenario.system, scenario.h, scenario.system.n_a
    A, b = hand_rows(scenario, system.kinematics(q))
    tau = system.gravity_force(q, scenario.gravity)
    change = system.difference(q, system.with_actuated(q, q_bar_a))[:n_a]
    P = np.zeros((system.n_v, system.n_v))
    P[:n_a, :n_a], P[n_a:, n_a:] = h * scenario.K_q, system.M_u(q) / h
    g = h * np.concatenate([scenario.K_q @ change, tau[n_a:]])
    scale = 1e-3  # metres in millimetres, so that absolute tolerances mean something
    x = solve_qp(P, -g / scale, -A, -b / scale, solver="daqp", primal_tol=1e-9)
    if x is None:
        raise RuntimeError("the hand-written loop found no solution")
    return np.asarray(scale * x)
