"""What a square patch of four points holds against a turn depends on its tangents.

A rigid patch that turns rests on its outermost points, (R16). Each of them slides across its
radius, and the pyramid asks it to rise by mu_v times the larger of the slip along d1 and that along
d2. So the patch holds mu_v m g a only where d1 or d2 lies along the slip, and cos(e) of that where
the nearer of the two is an angle e off the slip: at the corners of a square with tangents along its
sides 1 / sqrt(2). In the ellipsoid tangents do not matter.
"""

import numpy as np

from quasistatic_ref.lab.made_steps.contacts import GRAVITY, Z
from quasistatic_ref.lab.made_steps.rigid import rigid_step
from quasistatic_ref.step.data import StepData

M, INERTIA, MU_V, RADIUS, HEIGHT, H = 0.5, 2e-4, 0.5, 0.03, 0.02, 0.01
"""Mass [kg], inertia [kg m^2], friction [-], from the middle to a corner, to the floor [m], [s]."""


def patch(torque: float, angle: float, cone: str = "pyramid", mu_v: float = MU_V) -> StepData:
    """A square on its corners, under its weight and a torque about the vertical.

    Parameters
    ----------
    torque : float
        Over mu_v m g a [-].
    angle : float
        From the slip of a corner to its d1 [deg]; 45: tangents along the sides.
    cone : str
    mu_v : float
        [-].
    """
    middle = np.pi / 2 * np.arange(4) + np.pi / 4
    corners = RADIUS * np.column_stack(
        [np.cos(middle), np.sin(middle), np.full(4, -HEIGHT / RADIUS)]
    )
    along = middle + np.pi / 2 + np.radians(angle)
    d1 = np.column_stack([np.cos(along), np.sin(along), np.zeros(4)])
    frames = np.stack([d1, np.cross(Z, d1), np.tile(Z, (4, 1))], axis=1)
    wrench = (0, 0, -M * GRAVITY, 0, 0, torque * mu_v * M * GRAVITY * RADIUS)
    step = rigid_step(M, INERTIA, wrench, corners, frames, mu_v=mu_v, h=H)
    return step.replace(cone=cone)
