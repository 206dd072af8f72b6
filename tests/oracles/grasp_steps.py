"""Random steps that look like a grasp: a body between two fingers, over a floor.

The coordinates are those of the gripper, a stiff floating base and a width, then the twist of the
body. Contacts are between the gripper and the body, six rows, or a floor and the body, four rows.
"""

import numpy as np

from quasistatic_ref import StepData
from tests.made import GRAVITY, Rng, X, Y, Z, contacts_of, frames_about, point_jacobian

STIFFNESS = np.array([800.0, 800.0, 800.0, 20.0, 20.0, 20.0, 2000.0])
"""Of the gripper's base and of its width [N/m, N m/rad]."""


def grasp_step(rng: Rng, grip: int = 10, floor: int = 5) -> StepData:
    """A body turned at random, which a gripper and the floor touch.

    Parameters
    ----------
    rng : numpy.random.Generator
    grip, floor : int
        Contacts of each kind.

    Returns
    -------
    StepData
        SI units: a body of about 0.2 kg and 0.1 m, h = 0.01 s.
    """
    n_c = grip + floor
    number = np.arange(n_c)
    gripped = number < grip
    side = np.where(gripped, np.where(number % 2, 1.0, -1.0), 0.0)  # which finger; 0 is the floor
    mass = 0.2 * (1 + rng.random())
    R = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    inertia = R @ np.diag(mass * 1e-3 * (0.5 + rng.random(3))) @ R.T
    M_u = np.zeros((6, 6))
    M_u[:3, :3] = mass * np.eye(3)
    M_u[3:, 3:] = (inertia + inertia.T) / 2
    lift = np.array([0, 0, rng.choice([0.0, 2e-4]), 0, 0, 0])
    squeeze = rng.uniform(0, 2e-3)
    target = np.append(lift + 1e-5 * rng.standard_normal(6), -squeeze)
    n = np.zeros((n_c, 3))
    at = np.zeros((n_c, 3))
    for j in range(n_c):  # one contact after another, as their numbers are drawn
        if gripped[j]:
            n[j] = side[j] * X + 0.05 * rng.standard_normal(3)
            at[j] = -0.03 * side[j] * X + 0.005 * rng.standard_normal(3)
        else:
            n[j], at[j] = Z, [*(0.04 * rng.standard_normal(2)), -0.04]
        n[j] /= np.linalg.norm(n[j])
    J = np.zeros((n_c, 4, 13))
    J[:, :, 7:] = point_jacobian(at, n)
    J[gripped, :, :6] = -J[gripped, :, 7:]
    J[:, 0, 6] = side / 2
    contacts = contacts_of(
        phi=np.where(rng.random(n_c) < 0.5, 1e-6, 1e-4) * rng.standard_normal(n_c),
        frames=frames_about(n, -Y),
        J=J,
        mu_v=rng.uniform(0.3, 0.9, n_c),
        mu_omega=rng.uniform(0.005, 0.02, n_c),
        rows=np.where(gripped, 6, 4),
    )
    return StepData(
        h=0.01,
        K_q=np.diag(STIFFNESS),
        M_u=M_u,
        tau_a=np.zeros(7),
        tau_u=-GRAVITY * mass * np.eye(6)[2],
        delta_q_bar_a=target,
        contacts=contacts,
    )
