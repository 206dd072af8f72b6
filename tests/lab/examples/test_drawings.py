"""The two figures that docs/tour.md draws itself: their numbers, and that they are drawn."""

import numpy as np
import pytest
from matplotlib import pyplot as plt

from docs.drawings import corner_loads, the_program
from quasistatic_ref.optional.show.figures import figure_style
from tests.legible import faults
from tests.tolerances import ROUNDING


def test_a_push_moves_the_load_to_the_corner_ahead():
    # Moments about a lower corner: m g / 2 -+ F c / (2 w), c the height of the centre of mass.
    for push, (friction, left, right) in zip(corner_loads.PUSHES, corner_loads.main(), strict=True):
        half = 9.81 / 2
        shift = push * 0.04 / (2 * 0.05)
        expected = [-push, half - shift, half + shift]
        np.testing.assert_allclose([friction, left, right], expected, rtol=ROUNDING, atol=ROUNDING)


def test_the_point_is_held_at_3_N_and_slides_along_its_row_at_8_N():
    # (R8), one row: dx = h^2 (F - mu m g) / (m (1 + mu^2)), dz = mu dx.
    dx = 0.01**2 * (8.0 - 0.5 * 9.81) / (1 + 0.5**2)
    np.testing.assert_allclose(
        the_program.main(), [[0.0, 0.0], [dx, 0.5 * dx]], rtol=ROUNDING, atol=0.0
    )


@pytest.mark.parametrize("module", [corner_loads, the_program])
def test_the_figure_has_a_panel_for_each_push_and_is_legible(module):
    with figure_style():
        made = module.figure()
    assert len(made.axes) == len(module.PUSHES)
    assert faults(made) == []
    plt.close(made)
