"""A slider pushed on the plane, (R28): exact steps under random loads against its formulas.

`quasistatic-ref validate planar_push` sweeps pushers that stick, and those without friction.
"""

import numpy as np
import pytest
from scipy.optimize import brentq

from quasistatic_ref import solve_step
from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.tolerances import CLOSED_FORM
from tests.closeness import assert_within

G = 9.81


@pytest.mark.parametrize("seed", range(12))
def test_r28_a_push_turns_a_slider_by_lynch_s_law_with_another_c(seed):
    """F at r: F along v, c~^2 omega = r x v, and v from the motion u of the touched point.

    c~^2 = (c^2 + Pi rho^2) / (1 + Pi), Pi = (m / h^2) / (N mu^2 / s): from the floor
    s / (mu^2 (g h^2 + s)), in steady motion ||xi|| / (mu g h^2).
    """
    rng = np.random.default_rng(seed)
    m, h, mu, c, rho = 10 ** rng.uniform([-2, -3, -1, -2.5, -2.5], [1, -1, 0, -1, -1])
    x, y = r = rng.normal(size=2) * 0.05
    turn = rng.uniform(0, 2 * np.pi)
    F = mu * m * G * rng.uniform(1.1, 9) * np.array([np.cos(turn), np.sin(turn)])
    torque = x * F[1] - y * F[0]

    def excess(gap):
        """Of a steady motion over that with this gap."""
        k = m * G * mu**2
        along = mu**2 * (F @ F) / (m * gap / h**2 + k) ** 2
        return along + (mu * c * torque / (m * rho**2 * gap / h**2 + k * c**2)) ** 2 - 1

    steady = brentq(excess, 0.0, 1e3, xtol=1e-300, rtol=1e-15)
    for phi in (0.0, 0.5 * steady, steady):
        contact = contacts_of(phi, np.eye(3), np.eye(4)[None], mu, c * mu, rows=6)
        step = free_step(np.diag([m, m, m, m * rho**2]), [*F, -m * G, torque], contact, h)
        answer = solve_step(step.replace(cone="ellipsoid"), "clarabel")
        assert answer.certificate.kind == "enclosure"
        v = answer.delta_q[:2]
        rise, omega = answer.delta_q[2:]
        size = np.hypot(np.linalg.norm(v), c * omega)
        s = mu * size
        N = m * G + m * rise / h**2
        Pi = (m / h**2) / (N * mu**2 / s)
        c2 = (c**2 + Pi * rho**2) / (1 + Pi)
        near(phi + rise, s, s)
        near(answer.wrench[0, 2], N, N)
        # Along the normal of the limit surface f^2 / (mu N)^2 + tau^2 / (mu c N)^2 = 1.
        support = -mu * N / size * np.array([*v, c * omega])
        near(answer.wrench[0, [0, 1, 3]] / [1, 1, c], support, mu * N)
        near(F, (1 + Pi) * N * mu**2 / s * v, np.abs(F).max())
        near(c2 * omega, x * v[1] - y * v[0], size * (np.hypot(*r) + c))
        u = v + omega * np.array([-y, x])
        given = np.array([(c2 + x * x) * u[0] + x * y * u[1], x * y * u[0] + (c2 + y * y) * u[1]])
        near(given / (c2 + r @ r), v, np.abs(u).max() * (1 + r @ r / c2))
        n = F / np.linalg.norm(F)  # also of a pusher without friction, which advances by u . n
        arm = x * n[1] - y * n[0]
        near(u @ n / (1 + arm**2 / c2) * n, v, np.abs(u).max())
        if phi == 0.0:
            near(Pi, s / (mu**2 * (G * h**2 + s)), 1 + Pi)
        if phi == steady:
            near([rise, Pi], [0.0, size / (mu * G * h**2)], [s, 1 + Pi])


def near(found, expected, scale):
    assert_within(np.subtract(found, expected) / scale, 0.0, CLOSED_FORM)
