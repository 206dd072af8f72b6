"""The figures that pages of docs/course/ draw: their numbers, and that they are drawn."""

import numpy as np
import pytest
from matplotlib import pyplot as plt

from docs.drawings import contact_geometry, corner_loads, free_body, sliding_block, the_program
from quasistatic_ref.optional.show.figures import figure_style
from tests.closeness import assert_close, assert_relative
from tests.tolerances import ROUNDING


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


@pytest.mark.parametrize(
    "module", [contact_geometry, corner_loads, free_body, sliding_block, the_program]
)
def test_the_figure_has_its_panels(module):
    with figure_style():
        made = module.figure()
    assert len(made.axes) >= 2
    plt.close(made)
