r"""How gap, slips and spin of all contacts change with q, and what multipliers exert: (R34).

Gap, slips and spin of a contact are products of screws with the twists of its links, all at the
world's origin. The motion of the point :math:`\beta` along a unit vector e has the screw
:math:`[e;\, \beta\times e]`, with n, :math:`\mu_v d_1` and :math:`\mu_v d_2` for e. The spin has
:math:`[0;\, \mu_\omega n]`. Those of alpha's link are the opposite ones, at :math:`\alpha`.
Multipliers exert the same screws as wrenches. Screws are differentiated by the product rule, with
everything that a contact is.
"""

import numpy as np

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.pairs import ContactLayout
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import crossed
from quasistatic_ref.optional.derivatives.contact.closest_point_rates import Rates
from quasistatic_ref.optional.derivatives.contact.contact_rates import tangent_rates
from quasistatic_ref.optional.derivatives.model.motion_rates import MotionRates
from quasistatic_ref.optional.friction import scaled_by
from quasistatic_ref.step.data import Contacts


class RowRates:
    """The contacts of a step with their derivatives.

    Parameters
    ----------
    contacts : Contacts
    points : ClosestPoints
    layout : ContactLayout
    rates : Rates
    motion : MotionRates

    Attributes
    ----------
    screws : ndarray, shape (2, n_c, 6, 4)
        Of beta's links and of alpha's, by which gap, slips and spin are products with twists.
    d_screws : ndarray, shape (2, n_c, 6, 4, n_v)
        Their derivatives by q.
    """

    def __init__(
        self,
        contacts: Contacts,
        points: ClosestPoints,
        layout: ContactLayout,
        rates: Rates,
        motion: MotionRates,
    ) -> None:
        self.rates = rates
        self.motion = motion
        self.links = np.stack([layout.link_beta, layout.link_alpha])
        frames = np.stack([contacts.n, contacts.d1, contacts.d2], axis=2)
        d_frames = np.stack([rates.n, *tangent_rates(contacts, rates.n)], axis=2)
        screws, d_screws = _screws(
            np.concatenate([points.beta, points.alpha]),
            np.concatenate([rates.beta, rates.alpha]),
            np.concatenate([frames, -frames]),
            np.concatenate([d_frames, -d_frames]),
        )
        scale = scaled_by(contacts)[:, None]
        sides = 2, contacts.n_c
        self.screws = screws.reshape(*sides, 6, 4) * scale
        self.d_screws = d_screws.reshape(*sides, *d_screws.shape[1:]) * scale[..., None]

    def of_motion(self, x: Array) -> Array:
        """Derivatives by q of gap, slips and spin, (n_c, 4, n_v), x (n_v,) being fixed [m]."""
        twists = (self.motion.J @ x)[self.links]
        d_twists = self.motion.twist_rates(x)[self.links]
        motion_rates = np.einsum("sjaik,sja->jik", self.d_screws, twists)
        motion_rates += (self.screws.transpose(0, 1, 3, 2) @ d_twists).sum(axis=0)
        motion_rates[:, 0] += self.rates.phi
        return np.asarray(motion_rates)

    @property
    def terms(self) -> Array:
        """How fast the closest points move, the fastest of them, shape (n_v,) [m per unit]."""
        r = self.rates
        return np.asarray(np.abs(np.stack([r.alpha, r.beta])).max(axis=(0, 1, 2), initial=0.0))

    def pull(self, y: Array) -> Array:
        """Derivative by q of what multipliers y (n_c, 4) exert, (n_v, n_v) [N s]."""
        wrenches = np.zeros(self.motion.J.shape[:2])
        d_wrenches = np.zeros(self.motion.J.shape)
        np.add.at(wrenches, self.links, np.einsum("sjai,ji->sja", self.screws, y))
        np.add.at(d_wrenches, self.links, np.einsum("sjaik,ji->sjak", self.d_screws, y))
        return self.motion.force_rates(wrenches, d_wrenches)


def _screws(at: Array, d_at: Array, axes: Array, d_axes: Array) -> tuple[Array, Array]:
    """Screws (N, 6, 4) of the motions of points along three axes and about the first; their rates.

    The axes are the columns of `axes`, (N, 3, 3), and all rates, (..., n_v), are by q.
    """
    N, _, n_v = d_at.shape
    arm = at[:, :, None]
    screws = np.zeros((N, 6, 4))
    screws[:, :3, :3] = axes
    screws[:, 3:, :3] = crossed(arm, axes)
    screws[:, 3:, 3] = axes[:, :, 0]
    rates = np.zeros((N, 6, 4, n_v))
    rates[:, :3, :3] = d_axes
    turned = crossed(d_at[:, :, None], axes[..., None])
    rates[:, 3:, :3] = turned + crossed(arm[..., None], d_axes)
    rates[:, 3:, 3] = d_axes[:, :, 0]
    return screws, rates
