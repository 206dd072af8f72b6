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
from quasistatic_ref.optional.derivatives.contact.contact_rates import ContactRates, tangent_rates
from quasistatic_ref.optional.derivatives.model.motion_rates import MotionRates
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
    rates : ContactRates
    motion : MotionRates
    """

    contacts: Contacts
    points: ClosestPoints
    layout: ContactLayout
    rates: ContactRates
    motion: MotionRates

    def of_motion(self, x: Array) -> Array:
        """Derivatives by q of gap, slips and spin, (n_c, 4, n_v), x (n_v,) being fixed [m]."""
        c = self.contacts
        r = self.rates
        twist = self.motion.twists(x)
        d_twist = self.motion.twist_rates(x)
        u = np.zeros((c.n_c, 3))
        d_u = np.zeros((c.n_c, 3, len(x)))
        turn = u.copy()
        d_turn = d_u.copy()
        for link, r_point, d_point, sign in self._ends():
            nu = twist[link, :3]
            omega = twist[link, 3:]
            d_nu = d_twist[link, :3]
            d_omega = d_twist[link, 3:]
            u += sign * (nu + crossed(omega, r_point))
            d_u += sign * (
                d_nu + crossed(d_omega, r_point[:, :, None]) + crossed(omega[:, :, None], d_point)
            )
            turn += sign * omega
            d_turn += sign * d_omega
        d_d1, d_d2 = self.tangents
        found = np.empty((c.n_c, 4, len(x)))
        found[:, 0] = r.phi + _along(u, r.n) + _along(c.n, d_u)
        found[:, 1] = _along(u, d_d1) + _along(c.d1, d_u)
        found[:, 2] = _along(u, d_d2) + _along(c.d2, d_u)
        found[:, 3] = _along(turn, r.n) + _along(c.n, d_turn)
        found[:, 1:] *= c.mu[:, :, None]
        return found

    @cached_property
    def tangents(self) -> tuple[Array, Array]:
        """Derivatives of d1 and d2, each of shape (n_c, 3, n_v)."""
        return tangent_rates(self.contacts.n, self.rates.n)

    @property
    def terms(self) -> Array:
        """How fast the closest points move, the fastest of them, shape (n_v,) [m per unit]."""
        r = self.rates
        return np.asarray(np.abs(np.stack([r.alpha, r.beta])).max(axis=(0, 1, 2), initial=0.0))

    def pull(self, y: Array) -> Array:
        """Derivative by q of what multipliers y (n_c, 4) exert, (n_v, n_v) [N s]."""
        c = self.contacts
        r = self.rates
        d_d1, d_d2 = self.tangents
        y0 = y[:, 0, None]
        y1 = (c.mu[:, 0] * y[:, 1])[:, None]
        y2 = (c.mu[:, 1] * y[:, 2])[:, None]
        force = y0 * c.n + y1 * c.d1 + y2 * c.d2
        d_force = y0[:, None] * r.n + y1[:, None] * d_d1 + y2[:, None] * d_d2
        y3 = (c.mu[:, 2] * y[:, 3])[:, None]
        links = len(self.motion.moves)
        wrench = np.zeros((links, 6))
        d_wrench = np.zeros((links, 6, r.phi.shape[1]))
        for link, r_point, d_point, sign in self._ends():
            moment = crossed(r_point, force) + y3 * c.n
            d_moment = crossed(d_point, force[:, :, None]) + crossed(r_point[:, :, None], d_force)
            d_moment += y3[:, None] * r.n
            np.add.at(wrench, link, sign * np.concatenate([force, moment], axis=1))
            np.add.at(d_wrench, link, sign * np.concatenate([d_force, d_moment], axis=1))
        return self.motion.force_rates(wrench, d_wrench)

    def _ends(self) -> tuple[tuple[Indices, Array, Array, float], ...]:
        """Links, points, their derivatives and the sign of both bodies."""
        p = self.points
        r = self.rates
        of = self.layout
        return (of.link_beta, p.beta, r.beta, 1.0), (of.link_alpha, p.alpha, r.alpha, -1.0)


def _along(vectors: Array, rates: Array) -> Array:
    return np.asarray(np.einsum("ja,jak->jk", vectors, rates))
