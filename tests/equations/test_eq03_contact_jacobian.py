"""Eq. (3), J = df/dv, column by column. Under test: contact.jacobian.ContactGeometry."""

import numpy as np

from quasistatic_ref.lab.made_steps.link_jacobian import contact_jacobian
from tests.oracles.printed_rows import LINKS, relative_velocity
from tests.tolerances import DIFFERENCE


def test_every_column_is_a_central_difference(scene, q, rng):
    """Its transpose maps four numbers, a force and a torque about n, to forces of all joints."""
    a, b = np.array([[scene.link(name) for name in pair] for pair in LINKS.values()]).T
    alpha, beta, n = rng.normal(size=(3, len(a), 3))
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    J = contact_jacobian(scene.kinematics(q), a, b, alpha, beta, n)
    assert J.shape == (len(LINKS), 4, scene.n_v)
    for j, sides in enumerate(zip(a, b, alpha, beta, n, strict=True)):
        for k, v in enumerate(np.eye(scene.n_v)):
            expected = relative_velocity(scene, q, v, *sides)
            # Points sit some metres from the joints that carry them.
            np.testing.assert_allclose(J[j, :, k], expected, rtol=DIFFERENCE, atol=10 * DIFFERENCE)
