"""The largest torque that points of one rigid body hold by friction: a linear program."""

import numpy as np
from scipy.optimize import linprog

ALONG = np.array([[1.0, -1.0, 0.0, 0.0], [0.0, 0.0, 1.0, -1.0]])
"""d1 and d2 from the four parts of a friction force, each at least 0."""


def held_torque(points, d1):
    """Torque about the centre of mass over mu times the weight [m].

    Loads and friction that balance the weight and the torque: the friction of a point is at most
    its load in the pyramid, |f_1| + |f_2| <= N (the friction over mu).

    Parameters
    ----------
    points : array_like, shape (n, 2)
        From the centre of mass, along the floor [m].
    d1 : array_like, shape (n, 2)
        Tangents; d2 is a quarter turn further.
    """
    points = np.asarray(points)
    d1 = np.asarray(d1)
    n = len(points)
    d2 = np.stack([-d1[:, 1], d1[:, 0]], axis=1)
    force = np.einsum("nkx,kp->xnp", np.stack([d1, d2], axis=1), ALONG)
    torque = points[:, 0, None] * force[1] - points[:, 1, None] * force[0]
    none = np.zeros((n, 1))
    unit = np.vstack([np.ones(n), points.T, np.zeros((2, n))])  # of the loads
    parts = np.vstack([np.zeros((3, 4 * n)), force.reshape(2, -1)])  # of the friction
    pyramid = np.hstack([-np.eye(n), np.kron(np.eye(n), np.ones(4))])
    found = linprog(
        -np.append(none, torque),
        A_ub=pyramid,
        b_ub=none[:, 0],
        A_eq=np.hstack([unit, parts]),
        b_eq=[1.0, 0.0, 0.0, 0.0, 0.0],
    )
    assert found.status == 0, found.message
    return -found.fun
