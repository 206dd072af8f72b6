r"""How gap, slips and spin of all contacts change with q, and what multipliers exert: (R34).

At a fixed displacement x, a contact's relative velocity is :math:`u = \nu_\beta +
\omega_\beta\times\beta - \nu_\alpha - \omega_\alpha\times\alpha`, of its links' twists, its gap
:math:`\phi + n\cdot u`, its slips :math:`\mu_v d_i\cdot u`, and its spin
:math:`\mu_\omega n\cdot(\omega_\beta - \omega_\alpha)`. Multipliers y of these are a wrench on
beta's link, of the force :math:`f = y_0 n + \mu_v(y_1 d_1 + y_2 d_2)` through beta and the torque
:math:`\mu_\omega y_3 n`, and the opposite one, through alpha, on alpha's. Both are differentiated
by the product rule, with everything that a contact is.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.pairs import ContactLayout
from quasistatic_ref.optional.derivatives.contact.closest_point_rates import Rates
from quasistatic_ref.optional.derivatives.contact.contact_rates import tangent_rates
from quasistatic_ref.optional.derivatives.model.motion_rates import MotionRates, wrench_rates
from quasistatic_ref.step.data import Array, Contacts, Indices
from quasistatic_ref.step.ordered import crossed


@dataclass(frozen=True, eq=False)
class RowRates:
    """The contacts of a step with their derivatives.

    Parameters
    ----------
    contacts : Contacts
    points : ClosestPoints
    layout : ContactLayout
    rates : Rates
    motion : MotionRates
    """

    contacts: Contacts
    points: ClosestPoints
    layout: ContactLayout
    rates: Rates
    motion: MotionRates

    def of_motion(self, x: Array) -> Array:
        """Derivatives by q of gap, slips and spin, (n_c, 4, n_v), x (n_v,) being fixed [m]."""
        r = self.rates
        link, at, d_at = self.ends
        twist = (self.motion.J @ x)[link]
        d_twist = self.motion.twist_rates(x)[link]
        omega = twist[:, 3:]
        d_omega = d_twist[:, 3:]
        u = _relative(twist[:, :3] + crossed(omega, at))
        d_u = _relative(
            d_twist[:, :3] + crossed(d_omega, at[:, :, None]) + crossed(omega[:, :, None], d_at)
        )
        turn = _relative(omega)
        d_turn = _relative(d_omega)
        found = np.empty((len(u), 4, len(x)))
        found[:, :3] = self.frames @ d_u + np.einsum("ja,jiak->jik", u, self.frame_rates)
        found[:, 3] = _along(turn, r.n) + _along(self.contacts.n, d_turn)
        found[:, 0] += r.phi
        found[:, 1:] *= self.contacts.mu[:, :, None]
        return found

    @cached_property
    def ends(self) -> tuple[Indices, Array, Array]:
        """Links, points and their derivatives, shapes (2 n_c, ...), beta's first [-, m, m].

        Returns
        -------
        link : ndarray of int, shape (2 n_c,)
        at : ndarray, shape (2 n_c, 3)
            [m].
        d_at : ndarray, shape (2 n_c, 3, n_v)
            [m per m or rad].
        """
        of = self.layout
        link = np.concatenate([of.link_beta, of.link_alpha])
        at = np.concatenate([self.points.beta, self.points.alpha])
        return link, at, np.concatenate([self.rates.beta, self.rates.alpha])

    @cached_property
    def frames(self) -> Array:
        """Rows n, d1, d2 of each contact, shape (n_c, 3, 3) [-]."""
        return np.stack([self.contacts.n, self.contacts.d1, self.contacts.d2], axis=1)

    @cached_property
    def frame_rates(self) -> Array:
        """Derivatives of n, d1 and d2, shape (n_c, 3, 3, n_v) [-]."""
        d_n = self.rates.n
        return np.stack([d_n, *tangent_rates(self.contacts.n, d_n)], axis=1)

    @property
    def terms(self) -> Array:
        """How fast the closest points move, the fastest of them, shape (n_v,) [m per unit]."""
        r = self.rates
        return np.asarray(np.abs(np.stack([r.alpha, r.beta])).max(axis=(0, 1, 2), initial=0.0))

    def pull(self, y: Array) -> Array:
        """Derivative by q of what multipliers y (n_c, 4) exert, (n_v, n_v) [N s]."""
        c = self.contacts
        link, at, d_at = self.ends
        pressed = y.copy()
        pressed[:, 1:] *= c.mu
        force = _opposite(np.einsum("ji,jia->ja", pressed[:, :3], self.frames))
        d_force = _opposite(np.einsum("ji,jiak->jak", pressed[:, :3], self.frame_rates))
        torque = _opposite(pressed[:, 3, None] * c.n)
        d_torque = _opposite(pressed[:, 3, None, None] * self.rates.n)
        exerted, d_exerted = wrench_rates(at, d_at, force, d_force, torque, d_torque)
        links = len(self.motion.moves)
        wrench = np.zeros((links, 6))
        d_wrench = np.zeros((links, 6, d_at.shape[2]))
        np.add.at(wrench, link, exerted)
        np.add.at(d_wrench, link, d_exerted)
        return self.motion.force_rates(wrench, d_wrench)


def _relative(ends: Array) -> Array:
    """What is of beta's bodies, less what is of alpha's; shape (n_c, ...)."""
    n_c = len(ends) // 2
    return np.asarray(ends[:n_c] - ends[n_c:])


def _opposite(exerted: Array) -> Array:
    """What contacts exert, (n_c, ...), on beta's bodies, and the opposite on alpha's."""
    return np.concatenate([exerted, -exerted])


def _along(vectors: Array, rates: Array) -> Array:
    return np.asarray(np.einsum("ja,jak->jk", vectors, rates))
