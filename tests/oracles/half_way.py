"""A step whose numbers are half-way between two float64 numbers."""

import numpy as np

from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.lab.scenes.rigid import free_step


def half_way(k):
    """x_1 - x_2 = 1 and x_2 = k 2^-53, pressed: x_1 and its impulse are k 2^-53 off 1 and 2.

    So are the slacks of a third contact, far away and along x_2. J is 3 where it presses, so that
    no multiplier is half-way, too.
    """
    rows = np.zeros((3, 4, 2))
    rows[0, 0] = 3.0, -3.0
    rows[1, 0] = 0.0, 3.0
    rows[2, 0] = 0.0, 1.0
    phi = np.array([-3.0, -3.0 * k * 2.0**-53, 1.0])
    at = contacts_of(phi, [np.eye(3)[[1, 2, 0]]] * 3, rows, 0.0)
    return free_step(np.eye(2), [0.0, -8.0], at, 0.5).replace(cone="frictionless")
