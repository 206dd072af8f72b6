"""Eq. (3), J = df/dv, column by column. Under test: contact.jacobian.contact_jacobian."""

import numpy as np

from quasistatic_ref.contact.jacobian import contact_jacobian
from tests.equations.test_eq02_relative_velocity import LINKS, relative_velocity
from tests.tolerances import DIFFERENCE


def contacts_in(scene, q, rng):
    """Every pair of links above as one contact: arguments of contact_jacobian."""
    a = np.array([scene.link(pair[0]) for pair in LINKS.values()])
    b = np.array([scene.link(pair[1]) for pair in LINKS.values()])
    alpha, beta, n = rng.normal(size=(3, len(a), 3))
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    return a, b, alpha, beta, n


def test_every_column_is_a_central_difference(scene, q, rng):
    a, b, alpha, beta, n = contacts_in(scene, q, rng)
    J = contact_jacobian(scene.kinematics(q), a, b, alpha, beta, n)
    assert J.shape == (len(LINKS), 4, scene.n_v)
    for j in range(len(a)):
        for k in range(scene.n_v):
            v = [float(i == k) for i in range(scene.n_v)]
            expected = relative_velocity(scene, q, np.array(v), a[j], b[j], alpha[j], beta[j], n[j])
            # Points sit some metres from the joints that carry them.
            np.testing.assert_allclose(J[j, :, k], expected, rtol=DIFFERENCE, atol=10 * DIFFERENCE)


def test_erratum_the_transpose_of_J_maps_wrenches_to_joint_forces(scene, q, rng):
    # J, 4 x n_v, cannot multiply a force in R^3. At every velocity v the generalized forces
    # J'[f; tau_n] do the work that f and tau_n do on the motion (2): (J'[f; tau_n])'v.
    a, b, alpha, beta, n = contacts_in(scene, q, rng)
    J = contact_jacobian(scene.kinematics(q), a, b, alpha, beta, n)
    assert J.shape[2] not in (3, 4)
    for j in range(len(a)):
        wrench = rng.uniform(-1, 1, size=4)
        v = rng.uniform(-1, 1, size=scene.n_v)
        motion = relative_velocity(scene, q, v, a[j], b[j], alpha[j], beta[j], n[j])
        work = sum(wrench[r] * motion[r] for r in range(4))
        # Motions reach some metres a second, as in the test above.
        np.testing.assert_allclose(
            (J[j].T @ wrench) @ v, work, rtol=DIFFERENCE, atol=10 * DIFFERENCE
        )
