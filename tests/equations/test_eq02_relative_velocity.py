"""Eq. (2), f = [nu_beta - nu_alpha; n'(omega_beta - omega_alpha)]: motions of material points.

Under test: contact.jacobian.ContactGeometry.
"""

import numpy as np

from quasistatic_ref.lab.made_steps.link_jacobian import contact_jacobian
from tests.closeness import assert_close, assert_relative


def test_the_jacobian_times_a_velocity_is_that_of_two_material_points_across_a_gap(scene):
    # Turning at rate 1 about its own z, the box carries a point at R [r, 0, 0] along R [0, r, 0].
    q = scene.q_start
    box = scene.link("box/box")
    v = np.zeros(scene.n_v)
    v[scene.joint("box/base").v] = [0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    kinematics = scene.kinematics(q)
    R = kinematics.R[box]
    t = kinematics.t[box]
    beta = (t + 0.4 * R[:, 0])[None]
    alpha = (t + 0.1 * R[:, 0])[None]
    f = contact_jacobian(kinematics, np.array([0]), np.array([box]), alpha, beta, R[:, 2][None])
    assert_close(f[0, :3] @ v, 0.4 * R[:, 1])
    assert_relative(f[0, 3] @ v, 1.0)
    f = contact_jacobian(kinematics, np.array([box]), np.array([0]), alpha, beta, R[:, 2][None])
    assert_close(f[0, :3] @ v, -0.1 * R[:, 1])
    assert_relative(f[0, 3] @ v, -1.0)
