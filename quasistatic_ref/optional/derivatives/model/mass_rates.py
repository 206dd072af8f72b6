"""How the mass matrix and gravity's force change with q and with the masses of links: (R32)."""

import numpy as np

from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.model.system import System
from quasistatic_ref.optional.derivatives.model.motion_rates import MotionRates, wrench_rates
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.ordered import crossed


class MassRates:
    """Derivatives of M x and of gravity's generalised force at one configuration.

    Parameters
    ----------
    system : System
    kinematics : Kinematics
    motion : MotionRates
        Both at that configuration.
    """

    def __init__(self, system: System, kinematics: Kinematics, motion: MotionRates) -> None:
        self.motion = motion
        self.masses = system.masses
        R = kinematics.R
        self.centre = np.einsum("lab,lb->la", R, system.centres) + kinematics.t
        self.inertia = R @ system.inertias @ R.transpose(0, 2, 1)
        nu = motion.J[:, :3]
        omega = motion.J[:, 3:]
        self.omega = omega
        self.moved = nu + crossed(omega, self.centre[:, :, None])  # of the centres

    def inertial_force_rates(self, x: Array) -> Array:
        """Derivative by q of M x, shape (n_v, n_v), for a fixed x of shape (n_v,) [m, rad]."""
        c = self.centre
        m = self.masses[:, None]
        twist = self.motion.J @ x
        rates = self.motion.twist_rates(x)
        nu = twist[:, :3]
        omega = twist[:, 3:]
        d_nu = rates[:, :3]
        d_omega = rates[:, 3:]
        p = m * (nu + crossed(omega, c))
        spin = np.einsum("lab,lb->la", self.inertia, omega)
        d_c = self.moved
        d_p = m[:, None] * (
            d_nu + crossed(d_omega, c[:, :, None]) + crossed(omega[:, :, None], d_c)
        )
        d_spin = crossed(self.omega, spin[:, :, None]) + self.inertia @ (
            d_omega - crossed(self.omega, omega[:, :, None])
        )
        return self.motion.force_rates(*wrench_rates(c, d_c, p, d_p, spin, d_spin))

    def gravity_rates(self, gravity: Array) -> Array:
        """Derivative by q of gravity's generalised force, shape (n_v, n_v).

        Parameters
        ----------
        gravity : ndarray, shape (3,)
            [m/s^2], world frame.
        """
        weight = self.masses[:, None] * gravity
        none = np.zeros_like(self.moved)
        return self.motion.force_rates(
            *wrench_rates(self.centre, self.moved, weight, none, 0 * weight, none)
        )

    def by_masses(self, vector: Array) -> Array:
        """Generalised force of `vector` (3,) at each link's centre of mass, shape (n_v, L).

        Of gravity [m/s^2] it is the derivative of its force by the link's mass.
        """
        return np.asarray(np.einsum("lai,a->il", self.moved, vector))

    def inertial_by_masses(self, x: Array) -> Array:
        """Derivative of M x by each link's mass, shape (n_v, L), for x of shape (n_v,) [m, rad].

        The inertia about the link's centre of mass stays as it is.
        """
        return np.asarray(np.einsum("lai,la->il", self.moved, self.moved @ x))
