"""Layer 3: mechanisms, the order of their coordinates, poses, and Jacobians of contacts."""

import numpy as np

from .rotation import AXES, NONE, frame, rotation, skew, turn, unit

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
    kind = body["joint"]
    if kind == "floating":
        return rotation(q[3:]), q[:3]
    if kind == "planar":
        c, s = unit(q[2:])
        return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]), np.append(q[:2], 0)
    if kind == "revolute":
        return turn(body["axis"], np.cos(q[0]), np.sin(q[0])), NONE
    if kind == "continuous":
        return turn(body["axis"], *unit(q)), NONE
    if kind == "prismatic":
        return AXES, q[0] * unit(body["axis"])
    return AXES, NONE


def slices(mechanism):
    """{body: (slice of q, slice of delta_q)}, n_a, n_v: actuated first; none of a mimic."""
    places = {}
    i = 0
    k = 0
    n_a = 0
    for actuated in (True, False):
        for body in mechanism["bodies"]:
            if bool(body.get("actuated")) == actuated and "mimic" not in body:
                size_q, size_v = ENTRIES[body["joint"]]
                places[body["name"]] = slice(i, i + size_q), slice(k, k + size_v)
                i = i + size_q
                k = k + size_v
        n_a = k if actuated else n_a
    return places, n_a, k


def kinematics(mechanism, q):
    """{body: (R, t, J)}: J (6 x n_v) of the velocity of its origin and its angular velocity."""
    at, _, n_v = slices(mechanism)
    poses = {None: (AXES, NONE, np.zeros((6, n_v), dtype=int))}
    for body in mechanism["bodies"]:
        R0, t0, J0 = poses[body["parent"]]
        R_placed, t_placed = frame(body["placement"])
        Rp = R0 @ R_placed
        tp = R0 @ t_placed + t0
        mimic = body.get("mimic", {"of": body["name"], "multiplier": 1, "offset": 0})
        entries, columns = at[mimic["of"]]
        pace = mimic["multiplier"]
        position = np.array(q[entries])
        R_q, t_q = joint_pose(body, pace * position + mimic["offset"])
        R = Rp @ R_q
        t = Rp @ t_q + tp
        J = np.vstack([J0[:3] - skew(t - t0) @ J0[3:], J0[3:]])
        joint_columns = np.zeros((6, columns.stop - columns.start), dtype=R.dtype)
        if body["joint"] == "floating":
            joint_columns[:3, :3] = R
            joint_columns[3:, 3:] = R
        elif body["joint"] == "planar":
            joint_columns[:3, :2] = R[:, :2]
            joint_columns[3:, 2] = R[:, 2]
        elif body["joint"] != "fixed":
            along = Rp @ unit(body["axis"])
            moving = slice(0, 3) if body["joint"] == "prismatic" else slice(3, 6)
            joint_columns[moving, 0] = pace * along
        J = np.hstack([J[:, : columns.start], J[:, columns] + joint_columns, J[:, columns.stop :]])
        poses[body["name"]] = R, t, J
    return poses


def point_jacobian(at, point):
    """Velocity of a material point, and the angular velocity."""
    _, t, J = at
    return J[:3] - skew(np.array(point) - t) @ J[3:], J[3:]


def contact_jacobian(at, contact):
    """Velocity of beta relative to alpha, and the relative spin about n: 4 rows."""
    alpha = np.array(contact["alpha"])
    beta = np.array(contact["beta"])
    v_alpha, w_alpha = point_jacobian(at[contact["alpha_body"]], alpha)
    v_beta, w_beta = point_jacobian(at[contact["beta_body"]], beta)
    slip = v_beta - v_alpha
    spin = np.array(contact["n"]) @ (w_beta - w_alpha)
    return np.vstack([slip, spin])


def jacobian(case):
    """Layer 3: the J of each contact of a case."""
    at = kinematics(case["mechanism"], np.array(case["q"]))
    jacobians = []
    for contact in case["contacts"]:
        J = contact_jacobian(at, contact)
        jacobians.append(J)
    return {"J": jacobians}
