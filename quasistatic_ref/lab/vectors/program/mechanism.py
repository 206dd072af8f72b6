"""Layer 3: mechanisms, the order of their coordinates, poses, and Jacobians of contacts."""

import numpy as np

from .rotation import frame, rotation, skew, turn

ENTRIES = {  # of q, of delta_q
    "fixed": (0, 0),
    "revolute": (1, 1),
    "prismatic": (1, 1),
    "continuous": (2, 1),
    "floating": (7, 6),
    "planar": (4, 3),
}


def joint_pose(body, q):
    """(R, t) of a joint at its entries of q."""
    kind, none = body["joint"], np.zeros(3)
    if kind == "floating":
        return rotation(q[3:]), np.array(q[:3])
    if kind == "planar":
        c, s = np.array(q[2:]) / np.hypot(*q[2:])
        return turn([0, 0, 1], c, s), np.array([*q[:2], 0])
    if kind == "revolute":
        return turn(body["axis"], np.cos(q[0]), np.sin(q[0])), none
    if kind == "continuous":
        c, s = np.array(q) / np.hypot(*q)
        return turn(body["axis"], c, s), none
    if kind == "prismatic":
        return np.eye(3), q[0] * np.array(body["axis"]) / np.linalg.norm(body["axis"])
    return np.eye(3), none


def slices(mechanism):
    """{body: (slice of q, slice of delta_q)}, n_a, n_v: actuated first; none of a mimic."""
    found, i, k, n_a = {}, 0, 0, 0
    for actuated in (True, False):
        for body in mechanism["bodies"]:
            if bool(body.get("actuated")) == actuated and "mimic" not in body:
                size_q, size_v = ENTRIES[body["joint"]]
                found[body["name"]] = slice(i, i + size_q), slice(k, k + size_v)
                i, k = i + size_q, k + size_v
        n_a = k if actuated else n_a
    return found, n_a, k


def kinematics(mechanism, q):
    """{body: (R, t, J)}: J (6 x n_v) of the velocity of its origin and its angular velocity."""
    at, _, n_v = slices(mechanism)
    found = {None: (np.eye(3), np.zeros(3), np.zeros((6, n_v)))}
    for body in mechanism["bodies"]:
        R0, t0, J0 = found[body["parent"]]
        R_placed, t_placed = frame(body["placement"])
        Rp, tp = R0 @ R_placed, R0 @ t_placed + t0
        mimic = body.get("mimic", {"of": body["name"], "multiplier": 1.0, "offset": 0.0})
        entries, columns = at[mimic["of"]]
        pace, position = mimic["multiplier"], q[entries]
        R_q, t_q = joint_pose(body, pace * position + mimic["offset"])
        R, t = Rp @ R_q, Rp @ t_q + tp
        J, k = J0.copy(), columns.start
        J[:3] -= skew(t - t0) @ J0[3:]
        if body["joint"] == "floating":
            J[:3, k : k + 3] = R
            J[3:, k + 3 : k + 6] = R
        elif body["joint"] == "planar":
            J[:3, k : k + 2], J[3:, k + 2] = R[:, :2], R[:, 2]
        elif body["joint"] != "fixed":
            along = Rp @ body["axis"] / np.linalg.norm(body["axis"])
            moving = slice(0, 3) if body["joint"] == "prismatic" else slice(3, 6)
            J[moving, k] += pace * along
        found[body["name"]] = R, t, J
    return found


def point_jacobian(at, point):
    """Velocity of a material point, and the angular velocity."""
    _, t, J = at
    return J[:3] - skew(np.array(point) - t) @ J[3:], J[3:]


def jacobian(case):
    """Layer 3."""
    at = kinematics(case["mechanism"], np.array(case["q"]))
    found = []
    for contact in case["contacts"]:
        alpha = np.array(contact["alpha"])
        beta = np.array(contact["beta"])
        v_alpha, w_alpha = point_jacobian(at[contact["alpha_body"]], alpha)
        v_beta, w_beta = point_jacobian(at[contact["beta_body"]], beta)
        slip = v_beta - v_alpha
        spin = np.array(contact["n"]) @ (w_beta - w_alpha)
        found.append(np.vstack([slip, spin]))
    return {"J": found}
