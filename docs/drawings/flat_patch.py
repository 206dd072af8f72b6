"""What a square patch of four points holds against a turn depends on its tangents.

A rigid patch that turns rests on its outermost points, (R16). Each of them slides across its
radius, and the pyramid asks it to rise by mu_v times the larger of the slip along d1 and that along
d2. So the patch holds mu_v m g a only where d1 or d2 lies along the slip, and cos(e) of that where
the nearer of the two is an angle e off the slip: at the corners of a square with tangents along its
sides 1 / sqrt(2). In the ellipsoid tangents do not matter.
"""

from collections.abc import Sequence
from functools import cache

import numpy as np

from quasistatic_ref.lab.figures.labels import caption, label_axes
from quasistatic_ref.lab.scenes.contacts import GRAVITY, Z
from quasistatic_ref.lab.scenes.rigid import rigid_step
from quasistatic_ref.lab.thresholds import threshold
from quasistatic_ref.optional.show.figures import Figure, panels, scaled
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import StepData

M, INERTIA, MU_V, RADIUS, HEIGHT, H = 0.5, 2e-4, 0.5, 0.03, 0.02, 0.01
"""Mass [kg], inertia [kg m^2], friction [-], from the middle to a corner, to the floor [m], [s]."""

STILL = 1e-12
"""A turn below this [rad] is none: rounded tangents leave 1e-16, an enclosure 1e-18."""

PRECISION, DRAWN = 1e-6, 1e-3
"""Where bisections end [-]: for numbers, and for a figure."""
ANGLES = (0.0, 22.5, 45.0, 67.5, 90.0)
CONES = ("pyramid", "ellipsoid")


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


@cache
def least_turning_torque(
    angle: float, precision: float, cone: str = "pyramid", mu_v: float = MU_V
) -> float:
    """The least torque that turns the patch, over mu_v m g a [-], by bisection on steps.

    Parameters
    ----------
    angle : float
        From the slip of a corner to its d1 [deg].
    precision : float
        Where the bisection ends [-].
    cone : str
    mu_v : float
        [-].
    """

    def turns(torque: float) -> bool:
        answer = solve_step(patch(torque, angle, cone, mu_v), fast=True)
        return bool(abs(answer.delta_q[5]) > STILL)

    return threshold(turns, 0.5, 1.5, precision)


def main() -> dict[str, float]:
    """Torques that turn the square, each followed by its formula."""
    found: dict[str, float] = {}
    for angle in (0.0, 22.5, 45.0):
        found[f"torque with d1 {angle:g} degrees off the slip, over mu_v m g a [-]"] = (
            least_turning_torque(angle, PRECISION)
        )
        found[f"cos {angle:g} degrees [-]"] = float(np.cos(np.radians(angle)))
    found["torque in the ellipsoid, d1 45 degrees off [-]"] = least_turning_torque(
        45.0, PRECISION, "ellipsoid"
    )
    return found | {"the same [-]": 1.0}


def figure(*, angles: Sequence[float] = ANGLES, mu_v: float = MU_V) -> Figure:
    """What the patch holds against the angle of its tangents: formulas, and steps as marks.

    Parameters
    ----------
    angles : sequence of float
        At which steps are tried [deg].
    mu_v : float
        [-].
    """
    page, (axes,) = panels(4.6, 2.8)
    dense = np.radians(np.linspace(0, 90, 181))
    laws = np.maximum(np.cos(dense), np.sin(dense)), np.ones_like(dense)
    for cone, law, mark in zip(CONES, laws, "os", strict=True):
        axes.plot(np.degrees(dense), law, label=f"{cone}, (R16)")
        torques = [least_turning_torque(angle, DRAWN, cone, mu_v) for angle in angles]
        axes.plot(angles, torques, mark, color="black", markerfacecolor="none", clip_on=False,
                  markersize=scaled(5), label=f"{cone}, steps")  # fmt: skip
    axes.set(ylim=(0.65, 1.05), xticks=np.arange(0, 91, 15))
    label_axes(axes, r"angle from the slip to $d_1$ [deg]", r"torque / ($\mu_v m g a$) [-]",
             caption(H, "pyramid and ellipsoid"))  # fmt: skip
    return page
