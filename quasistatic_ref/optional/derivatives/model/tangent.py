r"""How (+) and (-) change with both of their arguments, in tangent coordinates on both sides.

A base at the pose T moves by :math:`T \oplus x = T \exp x`. With ad the bracket of twists,

.. math:: \exp(-x)\,\tfrac{d}{d\epsilon}\exp(x + \epsilon e) = J(x)\,e, \qquad
          J(x) = \sum_k \frac{(-\mathrm{ad}_x)^k}{(k + 1)!} ,

and moving T by e first moves the sum by :math:`e^{-\mathrm{ad}_x} e = (1 - \mathrm{ad}_x J(x))\,e`.
Of :math:`y = T' \ominus T = \log(T^{-1} T')`, the derivatives are :math:`J(y)^{-1}` by T' and
:math:`-J(-y)^{-1}` by T: (R30). For a joint both are one, or minus one.
"""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.model.joints.joint import COSINE_SINE, QUATERNION, Joint
from quasistatic_ref.model.joints.twist_joint import TwistJoint
from quasistatic_ref.model.screw import rows
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import crossed, length

TERMS = 28
"""Of the series: of a turn by pi the rest is below 1e-16 of the twist."""


def cross_matrix(r: Array) -> Array:
    """[r x], shape (..., 3, 3), of vectors r, shape (..., 3) [any unit]: [r x] w = r x w."""
    columns = crossed(r.reshape(-1, 3, 1), np.eye(3)[None])
    return columns.reshape(*r.shape, 3)


def bracket(S: Array, T: Array) -> Array:
    """The brackets S x T of twists, shape (N, 6, ...), linear part first.

    Parameters
    ----------
    S, T : ndarray, shape (N, 6, ...)
        [m, rad]; an axis of length 1 in the one stands for all of the other.
    """
    omega = S[:, 3:]
    linear = crossed(omega, T[:, :3]) + crossed(S[:, :3], T[:, 3:])
    return np.concatenate([linear, crossed(omega, T[:, 3:])], axis=1)


def adjoint(twist: Array) -> Array:
    """The matrix ad of a twist (6,) [m, rad], shape (6, 6): ad T is the bracket with T."""
    along, about = cross_matrix(twist.reshape(2, 3))
    ad = np.zeros((6, 6))
    ad[:3, :3] = ad[3:, 3:] = about
    ad[:3, 3:] = along
    return ad


def right_jacobian(ad: Array) -> Array:
    """J(x), shape (n, n), of the matrix ad, shape (n, n) [m, rad], of a twist x."""
    one = np.eye(len(ad))
    J = one
    for k in range(TERMS, 1, -1):  # from the last term on
        J = one - ad @ J / k
    return J


def sum_rates(joints: Sequence[Joint], delta_q: Array) -> tuple[Array, Array]:
    """Derivatives of q (+) delta_q by q and by delta_q, each of shape (n_v, n_v).

    Parameters
    ----------
    joints : sequence of Joint
        All joints.
    delta_q : ndarray, shape (n_v,)
    """
    by_q = np.eye(len(delta_q))
    by_change = np.eye(len(delta_q))
    for block, ad in _bases(joints, delta_q):
        by_change[block] = right_jacobian(ad)
        by_q[block] -= ad @ by_change[block]
    return by_q, by_change


def difference_rates(joints: Sequence[Joint], change: Array) -> tuple[Array, Array]:
    """Derivatives of q_next (-) q by q and by q_next, each of shape (n, n).

    Parameters
    ----------
    joints : sequence of Joint
    change : ndarray, shape (n,)
        q_next (-) q [m, rad] of all coordinates, or of the actuated ones, which come first.
    """
    by_q = -np.eye(len(change))
    by_next = np.eye(len(change))
    for block, ad in _bases(joints, change):
        by_q[block] = -np.linalg.inv(right_jacobian(-ad))
        by_next[block] = np.linalg.inv(right_jacobian(ad))
    return by_q, by_next


def entry_rates(joints: Sequence[Joint], q: Array) -> Array:
    """Derivative of the entries of q (+) e by e at 0, shape (n_q, n_v) [per m or rad].

    Its pseudo-inverse takes a change of the entries to tangent coordinates, the part along a
    quaternion, or along (cos, sin), being lost; also where these are not of length one.

    Parameters
    ----------
    joints : sequence of Joint
        All joints.
    q : ndarray, shape (n_q,)
    """
    E = np.zeros((joints[-1].q.stop, joints[-1].v.stop)) if joints else np.zeros((0, 0))
    for joint in joints:
        E[joint.q, joint.v] = _joint_rates(joint, q[joint.q])
    return E


def _joint_rates(joint: Joint, q: Array) -> Array:
    """The block of one joint, of its own entries of q, shape (k, n)."""
    n = joint.lengths
    turn = q[n:]
    E = np.eye(len(q), joint.v.stop - joint.v.start)
    if joint.unit_vector == QUATERNION:
        E[:n, :n] = rows((turn / length(turn)).tolist())[:n]
        E[n:, n:] = _quaternion_rates(turn)
    if joint.unit_vector == COSINE_SINE:
        c, s = turn
        E[:n, :n] = np.array([[c, -s], [s, c]])[:n, :n] / length(turn)
        E[n:, n:] = [[-s], [c]]
    return E


def _quaternion_rates(quaternion: Array) -> Array:
    """Derivative of a quaternion [x y z w], shape (4,), by a turn in its own frame, (4, 3)."""
    x, y, z, w = quaternion.tolist()
    return np.array([[w, -z, y], [z, w, -x], [-y, x, w], [-x, -y, -z]]) / 2


def _bases(joints: Sequence[Joint], change: Array) -> list[tuple[tuple[slice, slice], Array]]:
    """Of each joint that moves by a twist its block of a matrix, and ad of its part of a change."""
    blocks = []
    for joint in joints:
        if isinstance(joint, TwistJoint) and joint.v.stop <= len(change):
            axes = list(joint.twist)
            twist = np.zeros(6)
            twist[axes] = change[joint.v]
            blocks.append(((joint.v, joint.v), adjoint(twist)[axes][:, axes]))
    return blocks
