"""The paper's Figure 1 in two contacts: fingertips hold a bar off its centre of mass."""

import numpy as np

from quasistatic_ref.lab.made_steps.contacts import GRAVITY, X, Y, contacts_of, point_jacobian
from quasistatic_ref.step.data import StepData

HALF_WIDTH = 0.03
"""Of the bar, along x [m]."""
INERTIA = 1e-4
"""Of the bar, about each axis [kg m^2]."""
STIFFNESS = 1000.0
"""Of a finger [N/m]."""
H = 0.01
"""Time step [s]."""


def pinch_step(
    grip: float,
    offset: float,
    mu_v: float,
    mu_omega: float,
    *,
    m: float = 0.2,
    cone: str = "pyramid",
) -> StepData:
    """A bar between two fingers on the axis x; gravity pulls along -z, an axis of both frames.

    q_a: how far the left finger, along +x, and the right one, along -x, have closed; both touch.
    q_u: the twist of the bar at its centre of mass, axes along the world's.

    Parameters
    ----------
    grip : float
        Force that each finger presses with while the bar stays [N].
    offset : float
        Of the fingers along y, from the centre of mass [m].
    mu_v, mu_omega : float
        [-], [m].
    m : float
        Mass of the bar [kg].
    cone : str
    """
    n = np.array([X, -X])  # finger j closes along n
    frames = np.stack([[Y, Y], np.cross(n, Y), n], axis=1)
    J = np.zeros((2, 4, 8))
    J[[0, 1], :3, [0, 1]] = -n
    J[:, :, 2:] = point_jacobian(offset * Y - HALF_WIDTH * n, n)
    return StepData(
        h=H,
        K_q=STIFFNESS * np.eye(2),
        M_u=np.diag([m, m, m, INERTIA, INERTIA, INERTIA]),
        tau_a=np.zeros(2),
        tau_u=[0.0, 0.0, -m * GRAVITY, 0.0, 0.0, 0.0],
        delta_q_bar_a=np.full(2, grip / STIFFNESS),
        contacts=contacts_of(0.0, frames, J, mu_v, mu_omega, rows=6),
        cone=cone,
    )
