"""M_u and tau_u of a free body by hand: its centre of mass is not where its origin is.

A body's twist is the motion of its origin. The centre of mass, at r_m in its frame, moves by
v + omega x r_m, so that the kinetic energy couples v and omega, and the weight has the torque
r_m x m g about the origin. Together they make a body fall without turning; without the coupling it
would turn, (R3).
"""

import numpy as np
import pinocchio as pin

from docs.drawings.labels import label_axes
from quasistatic_ref.lab.figures.labels import caption
from quasistatic_ref.lab.made_steps.contacts import GRAVITY
from quasistatic_ref.lab.made_steps.systems import body_text, system_of
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled

M, LENGTH, TILT, H, STEPS = 0.5, 0.2, 20.0, 0.02, 9
"""A rod [kg], [m], its start [deg] about y; time step [s], steps that are drawn."""


def rod(length: float = LENGTH, tilt: float = TILT) -> tuple[System, Array, Array, Array]:
    """A rod along its x, whose origin is at its end.

    Parameters
    ----------
    length : float
        [m].
    tilt : float
        Of its x below the horizontal [deg].

    Returns
    -------
    tuple of System and ndarray, shapes (n_q,), (3,), (3, 3)
        The system and q; centre of mass in the rod's frame [m], inertia about it [kg m^2].
    """
    inertia = M * length**2 / 12 * np.array([1e-3, 1, 1])
    r_m = np.array([length / 2, 0, 0])
    system = system_of({"rod": body_text(M, inertia, com=r_m)})
    q = system.integrate(system.q_start, np.radians(tilt) * np.eye(6)[4])
    return system, q, r_m, np.diag(inertia)


def mass_matrix(m: float, r_m: Array, inertia: Array) -> Array:
    """M_u by hand, of the kinetic energy m |v + omega x r_m|^2 / 2 + omega' I omega / 2.

    Parameters
    ----------
    m : float
        [kg].
    r_m : ndarray, shape (3,)
        Centre of mass in the body's frame [m].
    inertia : ndarray, shape (3, 3)
        About the centre of mass [kg m^2].

    Returns
    -------
    ndarray, shape (6, 6)
        [kg, kg m, kg m^2].
    """
    C = -pin.skew(r_m)  # omega x r_m = C omega
    return np.block([[m * np.eye(3), m * C], [m * C.T, inertia + m * C.T @ C]])


def weight(m: float, r_m: Array, R: Array) -> Array:
    """tau_u by hand: the weight along the body's axes, and its torque about the origin, shape (6,).

    Parameters
    ----------
    m : float
        [kg].
    r_m : ndarray, shape (3,)
        [m].
    R : ndarray, shape (3, 3)
        Orientation.
    """
    force = R.T @ [0, 0, -m * GRAVITY]
    return np.concatenate([force, np.cross(r_m, force)])


def falls(length: float, tilt: float, h: float, coupled: bool, steps: int = STEPS) -> list[Array]:
    """Ends of the rod (2, 3) [m] before and after each step of a free fall.

    Parameters
    ----------
    length, tilt, h : float
        [m], [deg], [s].
    coupled : bool
        Whether M_u has its blocks m C.
    steps : int
    """
    system, q, r_m, inertia = rod(length, tilt)
    M_u = mass_matrix(M, r_m, inertia)
    if not coupled:
        M_u[:3, 3:] = M_u[3:, :3] = 0.0
    link = system.link("rod")
    ends = []
    for _ in range(steps + 1):
        at = system.kinematics(q)
        R = at.R[link]
        t = at.t[link]
        ends.append(np.array([t, t + R @ (2 * r_m)]))
        free = np.linalg.solve(M_u, weight(M, r_m, R))
        q = system.integrate(q, np.asarray(h**2 * free, dtype=np.float64))
    return ends


def figure(*, length: float = LENGTH, tilt: float = TILT, h: float = H) -> Figure:
    """Origin, centre of mass and weight; and the rod's fall, with the coupling and without.

    Parameters
    ----------
    length, tilt, h : float
        Of the rod [m]; of its start [deg]; [s].
    """
    page, (left, right) = panels(6.3, 3.2, columns=2)
    system, q, r_m, _ = rod(length, tilt)
    R = system.kinematics(q).R[system.link("rod")]
    ends = 1e3 * np.array([np.zeros(3), R @ (2 * r_m)])
    middle = ends.mean(axis=0)
    scale = 1e3 * length / 4
    left.plot(ends[:, 0], ends[:, 2], color="0.8", linestyle="-", linewidth=scaled(7))
    for axis, pattern in ((R[:, 0], "--"), (R[:, 2], ":")):
        left.plot([0, scale * axis[0]], [0, scale * axis[2]], pattern, color="black",
                  label=f"body's {'x' if pattern == '--' else 'z'}")  # fmt: skip
    left.plot(middle[0] * np.ones(2), middle[2] - [0, 1.4 * scale], color="#D55E00", linestyle="-",
              label=r"weight $m g$")  # fmt: skip
    left.plot(*middle[[0, 2]], "ko", markersize=scaled(5), label="centre of mass")
    left.plot(0, 0, "ks", markerfacecolor="white", markersize=scaled(5), label="origin")
    left.set(aspect="equal", xlim=(-0.3 * 1e3 * length, 1.1 * 1e3 * length))
    label_axes(left, "x [mm]", "z [mm]")
    for coupled, colour, pattern in ((False, "#D55E00", "--"), (True, "black", "-")):
        for k, pose in enumerate(falls(length, tilt, h, coupled)[:: STEPS // 3]):
            label = ("with $m C$" if coupled else "without $m C$") if k == 0 else None
            right.plot(*1e3 * pose[:, [0, 2]].T, pattern, color=colour, label=label)
            right.plot(*1e3 * pose[0, [0, 2]], "s", color=colour, markersize=scaled(3))
    right.set_aspect("equal")
    label_axes(right, "x [mm]", "z [mm]", caption(h, "frictionless"))
    return page
