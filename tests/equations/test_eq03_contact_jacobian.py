"""Eq. (3), J = df/dv, column by column. Under test: contact.jacobian.contact_jacobian."""

import numpy as np
import pytest

from quasistatic_ref.contact.jacobian import contact_jacobian
from tests.equations.test_eq02_relative_velocity import LINKS, relative_velocity
from tests.scenes import chain_scene
from tests.tolerances import DIFFERENCE, EXACT

MOVES = {
    "box/box": ("box/base",),
    "arm/lower": ("arm/base", "arm/swing", "arm/spin"),
    "arm/upper": ("arm/base", "arm/swing"),
    "arm/follower": ("arm/base", "arm/swing", "arm/spin", "arm/slide"),
    "arm/tool": ("arm/base", "arm/swing", "arm/spin", "arm/slide"),
    "desk/slider": ("desk/swing", "desk/spin", "desk/slide"),
    "desk/tool": ("desk/swing", "desk/spin", "desk/slide"),
    "world": (),
}
"""Which joints move which link; a mimic moves with the joint that it follows."""


def contacts_in(system, q, rng):
    """Every pair of links above as one contact: arguments of contact_jacobian."""
    a = np.array([system.link(pair[0]) for pair in LINKS.values()])
    b = np.array([system.link(pair[1]) for pair in LINKS.values()])
    alpha, beta, n = rng.normal(size=(3, len(a), 3))
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    return a, b, alpha, beta, n


@pytest.fixture
def system(tmp_path):
    return chain_scene(tmp_path)


def test_every_column_is_a_central_difference(system, rng):
    q = system.integrate(system.neutral(), rng.normal(size=system.n_v))
    a, b, alpha, beta, n = contacts_in(system, q, rng)
    J = contact_jacobian(system.kinematics(q), a, b, alpha, beta, n)
    assert J.shape == (len(LINKS), 4, system.n_v)
    for j in range(len(a)):
        for k in range(system.n_v):
            v = [float(i == k) for i in range(system.n_v)]
            expected = relative_velocity(
                system, q, np.array(v), a[j], b[j], alpha[j], beta[j], n[j]
            )
            # Points sit some metres from the joints that carry them.
            np.testing.assert_allclose(J[j, :, k], expected, rtol=DIFFERENCE, atol=10 * DIFFERENCE)


def test_erratum_the_transpose_of_J_maps_wrenches_to_joint_forces(system, rng):
    # J, 4 x n_v, cannot multiply a force in R^3. At every velocity v the generalized forces
    # J'[f; tau_n] do the work that f and tau_n do on the motion (2): (J'[f; tau_n])'v.
    q = system.integrate(system.neutral(), rng.normal(size=system.n_v))
    a, b, alpha, beta, n = contacts_in(system, q, rng)
    J = contact_jacobian(system.kinematics(q), a, b, alpha, beta, n)
    assert J.shape[2] not in (3, 4)
    for j in range(len(a)):
        wrench, v = rng.uniform(-1, 1, size=4), rng.uniform(-1, 1, size=system.n_v)
        motion = relative_velocity(system, q, v, a[j], b[j], alpha[j], beta[j], n[j])
        work = sum(wrench[r] * motion[r] for r in range(4))
        # Motions reach some metres a second, as in the test above.
        np.testing.assert_allclose(
            (J[j].T @ wrench) @ v, work, rtol=DIFFERENCE, atol=10 * DIFFERENCE
        )


def test_every_kind_of_joint_is_seen_to_move_something(system, rng):
    q = system.integrate(system.neutral(), rng.normal(size=system.n_v))
    J = contact_jacobian(system.kinematics(q), *contacts_in(system, q, rng))
    assert (np.abs(J[:, :3]).max(axis=(0, 1)) > 0.05).all()
    assert {joint.kind for joint in system.joints} == {
        "floating", "revolute", "continuous", "prismatic",
    }  # fmt: skip


def test_joints_that_carry_neither_point_have_zero_columns(system, rng):
    q = system.integrate(system.neutral(), rng.normal(size=system.n_v))
    J = contact_jacobian(system.kinematics(q), *contacts_in(system, q, rng))
    for j, (alpha_link, beta_link) in enumerate(LINKS.values()):
        carried = {*MOVES[alpha_link], *MOVES[beta_link]}
        for k, coordinate in enumerate(system.coordinates):
            if coordinate.joint not in carried:
                np.testing.assert_allclose(J[j, :, k], np.zeros(4), rtol=EXACT, atol=EXACT)


def test_a_contact_does_not_depend_on_its_company(system, rng):
    q = system.integrate(system.neutral(), rng.normal(size=system.n_v))
    a, b, alpha, beta, n = contacts_in(system, q, rng)
    kinematics = system.kinematics(q)
    together = contact_jacobian(kinematics, a, b, alpha, beta, n)
    for j in range(len(a)):
        one = slice(j, j + 1)
        alone = contact_jacobian(kinematics, a[one], b[one], alpha[one], beta[one], n[one])
        np.testing.assert_allclose(alone[0], together[j], rtol=EXACT, atol=EXACT)


def test_no_contacts_make_an_empty_jacobian(system):
    nowhere, empty = np.zeros(0, dtype=np.int64), np.zeros((0, 3))
    J = contact_jacobian(system.kinematics(system.q_start), nowhere, nowhere, empty, empty, empty)
    assert J.shape == (0, 4, system.n_v)
