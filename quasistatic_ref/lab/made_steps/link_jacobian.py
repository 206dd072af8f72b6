"""J of points of any two links, outside of a simulator."""

import numpy as np

from quasistatic_ref.contact.jacobian import ContactGeometry
from quasistatic_ref.contact.pairs import ContactLayout
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.step.contacts import spread


def contact_jacobian(
    kinematics: Kinematics,
    link_alpha: Indices,
    link_beta: Indices,
    alpha: Array,
    beta: Array,
    n: Array,
) -> Array:
    """J of Eq. :eq:`eq-3` between any links, shape (n_c, 4, n_v).

    Parameters
    ----------
    kinematics : Kinematics
    link_alpha, link_beta : ndarray of int, shape (n_c,)
        Numbers of the links; 0 is the world.
    alpha, beta, n
        As of :meth:`~quasistatic_ref.contact.jacobian.ContactGeometry.jacobian`.
    """
    nothing = np.zeros(len(n))
    layout = ContactLayout((), link_alpha, link_beta, nothing, nothing, link_alpha)
    geometry = ContactGeometry(layout, kinematics.column_map)
    own = geometry.jacobian(kinematics.columns, alpha, beta, n)
    return spread(own, geometry.column, geometry.n_v)
