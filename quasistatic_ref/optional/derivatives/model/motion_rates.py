r"""How the motion of links changes with q, and the forces that wrenches on them make: (R31).

In the world frame the column of a joint's coordinate is a twist :math:`S_j` that is constant in
the joint's own frame. Moving the coordinate k of a joint at or before it carries that frame along:

.. math:: \partial S_j / \partial q_k = S_k \times S_j ,

the bracket of twists, and nothing else changes :math:`S_j`. (Every coordinate of a base moves the
others of the same base: q is moved by q (+) eps e_k.) From this follow, for a fixed displacement x
and wrenches W on the links, the derivatives of the links' twists :math:`J x` and of the
generalised force :math:`J^T W`.
"""

import numpy as np

from quasistatic_ref.model.column_map import ColumnMap
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.ordered import crossed


class MotionRates:
    """Derivatives of what Jacobians of links make, at one configuration.

    Twists and wrenches are those at the world's origin: [velocity; angular velocity] and
    [force; moment].

    Parameters
    ----------
    kinematics : Kinematics
    column_map : ColumnMap

    Attributes
    ----------
    J : ndarray, shape (L, 6, n_v)
        Twist of each link per unit of delta_q [m, rad].
    """

    def __init__(self, kinematics: Kinematics, column_map: ColumnMap) -> None:
        self.columns = kinematics.columns
        self.moves = column_map.moves[:, 0]
        self.coordinates = column_map.coordinates
        self.J: Array = (self.columns * column_map.moves) @ self.coordinates
        # Column k carries column j along if it moves every link that j moves.
        others = self.moves.T @ (1 - self.moves)
        carried = others == 0
        nu = self.columns[:3].T
        omega = self.columns[3:].T
        turned = np.empty((6, *carried.shape))  # S_k x S_j at [:, j, k]
        turned[:3] = _each(omega, nu) + _each(nu, omega)
        turned[3:] = _each(omega, omega)
        self.turned: Array = turned * carried

    def twist_rates(self, x: Array) -> Array:
        """Derivatives by q of J x, shape (L, 6, n_v), x of shape (n_v,) [m, rad] being fixed."""
        of_columns = self.moves * (self.coordinates @ x)  # (L, n_x)
        flat = of_columns @ self.turned.transpose(1, 0, 2).reshape(len(self.coordinates), -1)
        return np.asarray(flat.reshape(len(self.moves), 6, -1) @ self.coordinates)

    def force_rates(self, wrenches: Array, rates: Array) -> Array:
        """Derivative by q of the generalised force of wrenches on the links, shape (n_v, n_v).

        Parameters
        ----------
        wrenches : ndarray, shape (L, 6)
            [N, N m], or those of impulses.
        rates : ndarray, shape (L, 6, n_v)
            Their derivatives by q [the same per m or rad].
        """
        direct = self.J.reshape(-1, self.J.shape[2]).T @ rates.reshape(-1, rates.shape[2])
        on_columns = self.moves.T @ wrenches  # (n_x, 6)
        carried = np.einsum("ajk,ja->jk", self.turned, on_columns)
        return np.asarray(direct + self.coordinates.T @ carried @ self.coordinates)


def wrench_rates(
    at: Array, d_at: Array, force: Array, d_force: Array, torque: Array, d_torque: Array
) -> tuple[Array, Array]:
    """Wrenches at the world's origin of forces that act at points, and their derivatives.

    Parameters
    ----------
    at, force, torque : ndarray, shape (N, 3)
        [m, N, N m], or those of impulses.
    d_at, d_force, d_torque : ndarray, shape (N, 3, n_v)
        Their derivatives by q [the same per m or rad].

    Returns
    -------
    ndarray, shape (N, 6)
    ndarray, shape (N, 6, n_v)
    """
    moment = crossed(at, force) + torque
    d_moment = crossed(d_at, force[:, :, None]) + crossed(at[:, :, None], d_force) + d_torque
    return (
        np.concatenate([force, moment], axis=1),
        np.concatenate([d_force, d_moment], axis=1),
    )


def _each(a: Array, b: Array) -> Array:
    """The products a_k x b_j at [:, j, k], shape (3, n, n); a and b have the shape (n, 3)."""
    return crossed(a.T[None], b[:, :, None]).transpose(1, 0, 2)
