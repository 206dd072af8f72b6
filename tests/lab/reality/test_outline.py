"""Outlines: area, centre, gyration, and the closest point, against formulas."""

import numpy as np
import pytest

from quasistatic_ref.lab.reality.outline import Outline
from tests.tolerances import ROUNDING

A = 0.06
B = 0.02
RECTANGLE = np.array([[0, 0], [A, 0], [A, B], [0, B]]) + np.array([0.1, -0.3])
BENT = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 0.2], [0.0, 1.0]])


def test_a_rectangle_has_the_area_centre_and_gyration_of_the_formulas():
    outline = Outline(RECTANGLE)
    assert outline.area == pytest.approx(A * B, rel=ROUNDING)
    assert outline.centre == pytest.approx([0.1 + A / 2, -0.3 + B / 2], rel=ROUNDING)
    # The mean square of x - A/2 over [0, A] is A^2 / 12.
    assert outline.gyration == pytest.approx(np.sqrt((A**2 + B**2) / 12), rel=1e-9)


def test_the_mean_distance_from_the_middle_of_a_square():
    # a / 6 (sqrt 2 + log(1 + sqrt 2)) for a side a; of a polygon near a disc, two thirds of r.
    square = Outline(0.09 * np.array([[0, 0], [1, 0], [1, 1], [0, 1]]))
    law = 0.09 / 6 * (np.sqrt(2) + np.log(1 + np.sqrt(2)))
    assert square.mean_distance == pytest.approx(law, rel=1e-9)
    turn = np.linspace(0, 2 * np.pi, 4000, endpoint=False)
    disc = Outline(0.05 * np.column_stack([np.cos(turn), np.sin(turn)]))
    assert disc.mean_distance == pytest.approx(0.05 * 2 / 3, rel=1e-5)


@pytest.mark.parametrize(
    ("point", "distance", "on", "normal"),
    [
        ((0.5, -0.25), 0.25, (0.5, 0.0), (0.0, 1.0)),  # below an edge
        ((-0.3, -0.4), 0.5, (0.0, 0.0), (0.6, 0.8)),  # beyond a corner
        ((0.1, 0.4), -0.1, (0.0, 0.4), (1.0, 0.0)),  # inside: out by the shortest way
        ((1.0, 0.0), 0.0, (1.0, 0.0), (0.0, 1.0)),  # on an edge
        ((1.0, 0.6), 0.4 / np.hypot(1, 0.8), None, None),  # in the notch, which is not convex
    ],
)
def test_the_closest_point_of_an_outline_with_a_notch(point, distance, on, normal):
    found = Outline(BENT).closest(np.array(point))
    assert found[0] == pytest.approx(distance, abs=ROUNDING)
    if on is not None:
        assert found[1] == pytest.approx(on, abs=ROUNDING)
        assert found[2] == pytest.approx(normal, abs=ROUNDING)
