r"""How the mass matrix and gravity's force change with q and with the masses of links: (R32).

A link's inertia I takes its twist v to its momentum, both at the world's origin. It is constant in
the link's frame, which a coordinate k carries along with the twist :math:`S_k`, so that
:math:`d(I v) = S_k \times^* I v + I\,(dv - S_k \times v)`.
"""

import numpy as np

from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.model.motion_rates import MotionRates
from quasistatic_ref.optional.derivatives.model.tangent import bracket, cross_matrix

SWAPPED = [3, 4, 5, 0, 1, 2]


class MassRates:
    """Derivatives of M x and of gravity's generalised force at one configuration.

    Parameters
    ----------
    system : System
    kinematics : Kinematics
    motion : MotionRates
        Both at that configuration.

    Attributes
    ----------
    moved : ndarray, shape (L, 3, n_v)
        Velocity of each link's centre of mass per unit of delta_q [m].
    """

    def __init__(self, system: System, kinematics: Kinematics, motion: MotionRates) -> None:
        self.motion = motion
        R = kinematics.R
        centre = np.einsum("lab,lb->la", R, system.centres) + kinematics.t
        unit = np.tile(np.eye(3), (len(centre), 1, 1))
        of_centre = np.concatenate([unit, -cross_matrix(centre)], axis=2)
        self.moved: Array = of_centre @ motion.J
        self.inertia = system.masses[:, None, None] * of_centre.transpose(0, 2, 1) @ of_centre
        self.inertia[:, 3:, 3:] += R @ system.inertias @ R.transpose(0, 2, 1)

    def inertial_force_rates(self, x: Array) -> Array:
        """Derivative by q of M x, shape (n_v, n_v), for a fixed x of shape (n_v,) [m, rad]."""
        return self._force_rates(self.motion.J @ x, self.motion.twist_rates(x))

    def gravity_rates(self, gravity: Array) -> Array:
        """Derivative by q of gravity's generalised force, shape (n_v, n_v).

        Parameters
        ----------
        gravity : ndarray, shape (3,)
            [m/s^2], world frame.
        """
        fall = np.concatenate([gravity, np.zeros(3)])
        return self._force_rates(np.tile(fall, (len(self.inertia), 1)), 0 * self.motion.J)

    def _force_rates(self, v: Array, dv: Array) -> Array:
        """Derivative by q of the force J'(I v) for twists v, (L, 6), with the rates dv."""
        S = self.motion.J
        v = v[:, :, None]
        momentum = self.inertia @ v
        # A wrench [force; moment] is carried along as a twist [moment; force] is.
        turned = bracket(S, momentum[:, SWAPPED])[:, SWAPPED]
        d_momentum = turned + self.inertia @ (dv - bracket(S, v))
        return self.motion.force_rates(momentum[:, :, 0], d_momentum)

    def by_masses(self, vectors: Array) -> Array:
        """Generalised force of vectors at the links' centres of mass, shape (n_v, L).

        Of gravity [m/s^2] it is the derivative of its force by the link's mass, and of the centres'
        motions `moved` @ x that of M x, the inertia about the centre staying as it is.

        Parameters
        ----------
        vectors : ndarray, shape (3,) or (L, 3)
            One for all links, or one for each [m/s^2, or m].
        """
        return np.asarray((self.moved * vectors[..., None]).sum(axis=1).T)
