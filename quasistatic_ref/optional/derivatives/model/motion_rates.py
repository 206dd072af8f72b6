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

from quasistatic_ref.model.column_map import JointColumns
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.model.tangent import bracket


class MotionRates:
    """Derivatives of what Jacobians of links make, at one configuration.

    Twists and wrenches are those at the world's origin: [velocity; angular velocity] and
    [force; moment].

    Parameters
    ----------
    kinematics : Kinematics
    column_map : JointColumns

    Attributes
    ----------
    J : ndarray, shape (L, 6, n_v)
        Twist of each link per unit of delta_q [m, rad].
    """

    def __init__(self, kinematics: Kinematics, column_map: JointColumns) -> None:
        columns = kinematics.columns
        self.moves = column_map.moves[:, 0]
        self.coordinates = np.eye(column_map.n_v)[column_map.owner]
        self.J: Array = (columns * column_map.moves) @ self.coordinates
        # Column k carries column j along if it moves every link that j moves.
        carried = self.moves.T @ (1 - self.moves) == 0
        turned = bracket(columns[None], columns.T[:, :, None])  # S_k x S_j at [j, :, k]
        self.turned: Array = turned * carried[:, None]

    def twist_rates(self, x: Array) -> Array:
        """Derivatives by q of J x, shape (L, 6, n_v), x of shape (n_v,) [m, rad] being fixed."""
        of_columns = self.moves * (self.coordinates @ x)  # (L, n_x)
        return np.asarray(np.tensordot(of_columns, self.turned, 1) @ self.coordinates)

    def force_rates(self, wrenches: Array, rates: Array) -> Array:
        """Derivative by q of the generalised force of wrenches on the links, shape (n_v, n_v).

        Parameters
        ----------
        wrenches : ndarray, shape (L, 6)
            [N, N m], or those of impulses.
        rates : ndarray, shape (L, 6, n_v)
            Their derivatives by q [the same per m or rad].
        """
        direct = np.tensordot(self.J, rates, ([0, 1], [0, 1]))
        on_columns = self.moves.T @ wrenches  # (n_x, 6)
        carried = np.einsum("jak,ja->jk", self.turned, on_columns)
        return np.asarray(direct + self.coordinates.T @ carried @ self.coordinates)
