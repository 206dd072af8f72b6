"""The figures that pages draw: their numbers, and that they are drawn."""

import numpy as np
import pytest
from matplotlib import pyplot as plt

from docs.drawings import (
    a_screw,
    boundary_layer,
    cone_surfaces,
    contact_geometry,
    corner_loads,
    finger_spring_block,
    flat_patch,
    free_body,
    mass_of_a_free_body,
    phi_and_j_of_a_cloud,
    pinch_threshold,
    sliding_block,
    the_program,
    the_step_loop,
    two_moving_bodies,
    which_cone_is_real,
)
from quasistatic_ref.lab.claims.paper.boundary_layer import FITTED
from quasistatic_ref.optional.show.figures import figure_style
from tests.closeness import assert_close, assert_relative
from tests.tolerances import ROUNDING, SCENARIO, THRESHOLD


def test_a_push_moves_the_load_to_the_corner_ahead():
    # Moments about a lower corner: m g / 2 -+ F c / (2 w), c the height of the centre of mass.
    for push, (friction, left, right) in zip(corner_loads.PUSHES, corner_loads.main(), strict=True):
        half = 9.81 / 2
        shift = push * 0.04 / (2 * 0.05)
        expected = [-push, half - shift, half + shift]
        assert_close([friction, left, right], expected, ROUNDING)


def test_the_point_is_held_at_3_N_and_slides_along_its_row_at_8_N():
    # (R8), one row: dx = h^2 (F - mu m g) / (m (1 + mu^2)), dz = mu dx.
    dx = 0.01**2 * (8.0 - 0.5 * 9.81) / (1 + 0.5**2)
    assert_relative(the_program.main(), [[0.0, 0.0], [dx, 0.5 * dx]], ROUNDING)


def test_the_table_balances_3_N_and_bears_6_N_on_the_edge_of_its_cone():
    # 3 N: weight and push are balanced. 6 N: m dx / h^2 = F - mu f_n, m dz / h^2 = f_n - m g with
    # dz = mu dx give f_n = (m g + mu F) / (1 + mu^2), and the friction is mu f_n.
    f_n = (9.81 + 0.5 * 6.0) / (1 + 0.5**2)
    expected = [[-3.0, 9.81], [-0.5 * f_n, f_n]]
    assert_close(free_body.main(), expected, ROUNDING)


def test_the_gap_of_the_sliding_block_is_that_of_r8_and_closes():
    # (R8): phi_k = phi* (1 - rho^k) with phi* = mu h^2 (F - mu m g) / m, rho = mu^2 / (1 + mu^2).
    steps = np.arange(61)
    gap = 0.5 * 0.01**2 * (6.0 - 0.5 * 9.81) * (1 - 0.2**steps)
    places = sliding_block.run()
    np.testing.assert_allclose(places[:61, 1], gap, rtol=1e-9, atol=ROUNDING * gap[-1])
    assert abs(places[62:, 1]).max() < ROUNDING * gap[-1]
    assert abs(np.diff(places[62:, 0])).max() == 0.0


@pytest.mark.parametrize("phi", [10.0, -10.0])
def test_beta_is_phi_along_n_from_alpha_and_the_ball_touches_at_alpha(phi):
    alpha, beta = contact_geometry.points(phi)
    assert_close(beta - alpha, phi * contact_geometry.N, ROUNDING)
    assert np.hypot(*alpha) == pytest.approx(contact_geometry.RADIUS, rel=ROUNDING)
    assert pytest.approx(0.0, abs=ROUNDING) == contact_geometry.N @ contact_geometry.D1


BISECTED = 1e-3
"""Where the bisections of a patch end here [-]."""
PAIRS = {
    # Lag: it approaches its limit by 1 / (1 + h^2 K_q / m) = 1 / 1.4 a step, 58 steps: 3e-9.
    the_step_loop: (0.0, 1e-8),
    finger_spring_block: (ROUNDING, 0.0),
    two_moving_bodies: (0.0, ROUNDING),
    mass_of_a_free_body: (0.0, ROUNDING),
    a_screw: (ROUNDING, 0.0),
    flat_patch: (0.0, 2 * BISECTED),
    pinch_threshold: (0.0, 100 * THRESHOLD),
}
"""Drawings whose numbers come in pairs, measured and expected: relative, absolute tolerance."""


@pytest.fixture
def coarse(monkeypatch):
    monkeypatch.setattr(flat_patch, "PRECISION", BISECTED)
    monkeypatch.setattr(flat_patch, "DRAWN", 0.25)


@pytest.mark.parametrize("module", PAIRS, ids=lambda module: module.__name__)
def test_measured_and_expected_stand_next_to_each_other_and_agree(module, coarse):
    numbers = list(module.main().values())
    np.testing.assert_allclose(numbers[0::2], numbers[1::2], *PAIRS[module])


def test_the_cones_have_the_volumes_of_octahedron_prism_and_ball():
    expected = [4 / 3, 2 * 2, 4 / 3 * np.pi]  # base 2, height 2 for the prism
    assert_relative(list(cone_surfaces.main().values()), expected, ROUNDING)


def test_phi_of_the_cloud_is_predicted_to_first_order():
    least, lowest, exponent, order = phi_and_j_of_a_cloud.main().values()
    assert_relative(least, lowest, ROUNDING)
    np.testing.assert_allclose(exponent, order, atol=FITTED)


def test_a_sphere_does_not_turn_up_to_mu_omega_m_g_and_its_layer_has_both_laws():
    stuck, limit, spin, lift, *exponents = boundary_layer.main().values()
    assert_relative(stuck, limit, SCENARIO)
    # phi = mu_omega h omega, in mm.
    assert_relative(lift, 1e3 * 0.01 * 0.01 * spin, SCENARIO)
    np.testing.assert_allclose(exponents, [1, 2], atol=FITTED)  # of h, at a rate and at a torque


def test_the_ellipsoid_predicts_pushes_far_better_than_the_pyramid():
    ratio, moved, turned, *errors = which_cone_is_real.main().values()
    # A square of side a under a uniform pressure: a / 6 (sqrt 2 + log(1 + sqrt 2)), a = 90 mm.
    uniform = 90 / 6 * (np.sqrt(2) + np.log(1 + np.sqrt(2)))
    assert ratio == pytest.approx(uniform, rel=0.1)
    ellipsoid, pyramid = np.array(errors).reshape(2, 2)
    assert (ellipsoid < np.array([moved, turned]) / 3).all()
    assert (pyramid > 1.5 * ellipsoid).all()


@pytest.mark.parametrize(
    "module",
    [contact_geometry, corner_loads, free_body, sliding_block, the_program, cone_surfaces,
     boundary_layer, phi_and_j_of_a_cloud, *PAIRS],
    ids=lambda module: module.__name__,
)  # fmt: skip
def test_the_figure_is_drawn(module, coarse):
    with figure_style():
        made = module.figure()
    assert made.axes
    plt.close(made)
