"""Residuals of a conic program whose cones are of every kind, against their closed forms."""

import numpy as np
import pytest

from quasistatic_ref.optional.extensions.conic import ConicProgram, conic_residuals
from tests.tolerances import ROUNDING

E = np.e
INSIDE = {
    "zero": [0.0, 0.0],
    "rows": [1.0],
    "ball": [3.0, 1.0, 2.0, 2.0],
    "horn": [2.0, 1.0, E**2],  # v exp(u / v) = w
}
DUALS = {
    "zero": [-3.0, 7.0],
    "rows": [0.0],
    "ball": [3.0, -1.0, -2.0, -2.0],
    "horn": [-2.0, 4.0, 2 * E**-3],  # -u exp(v / u) = e w
}


def residuals(slack=None, dual=None):
    """Of {0}^2, a row, a ball of four and a horn, with some slacks or multipliers replaced."""
    s, z = (np.concatenate(list((parts | (new or {})).values()))
            for parts, new in ((INSIDE, slack), (DUALS, dual)))  # fmt: skip
    program = ConicProgram(np.eye(1), np.zeros(1), np.zeros((10, 1)), s, 2, 1, (4,), 1)
    return conic_residuals(program, np.zeros(1), z)


def test_pairs_in_their_cones_are_feasible_and_multiplied_by_cone():
    """The ball's 9 - 1 - 4 - 4 = 0; the horn's -4 + 4 + 2 exp(-1), of which nothing cancels."""
    found = residuals()
    assert found.stationarity == 0.0
    assert found.primal == pytest.approx(0.0, abs=ROUNDING)
    assert found.dual == pytest.approx(0.0, abs=ROUNDING)
    assert found.complementarity == pytest.approx(2 / E, rel=ROUNDING)


@pytest.mark.parametrize(
    ("kind", "slack", "outside"),
    [
        ("zero", [0.0, -0.5], 0.5),
        ("rows", [-0.25], 0.25),
        ("ball", [2.0, 1.0, 2.0, 2.0], 1.0),
        ("horn", [2.0, 1.0, 1.0], E**2 - 1),
        # The cone's face v = 0: u <= 0 and w >= 0.
        ("horn", [0.5, 0.0, 1.0], 0.5),
        ("horn", [-1.0, 0.0, -0.5], 0.5),
        ("horn", [-1.0, -2.0, 1.0], 2.0),
    ],
)
def test_slacks_are_as_far_outside_as_is_said(kind, slack, outside):
    assert residuals(slack={kind: slack}).primal == pytest.approx(outside, abs=ROUNDING)


@pytest.mark.parametrize(
    ("kind", "dual", "outside"),
    [
        ("zero", [8.0, -9.0], 0.0),
        ("rows", [-0.25], 0.25),
        ("ball", [1.0, 0.0, 4.0, 0.0], 3.0),
        ("horn", [-3.0, -6.0, 2.0], 3 * E - 2),
        # The dual's face u = 0: v >= 0 and w >= 0.
        ("horn", [0.0, -0.5, 1.0], 0.5),
        ("horn", [0.0, 1.0, -0.5], 0.5),
        ("horn", [0.5, 1.0, 1.0], 0.5),
    ],
)
def test_multipliers_are_as_far_outside_as_is_said(kind, dual, outside):
    assert residuals(dual={kind: dual}).dual == pytest.approx(outside, abs=ROUNDING)


def test_balance_is_that_of_the_program():
    """P x + c + A'z = 2 3 + 1 - 4."""
    program = ConicProgram(
        np.array([[2.0]]), np.ones(1), np.array([[-1.0]]), np.zeros(1), 0, 1, (), 0
    )
    found = conic_residuals(program, np.array([3.0]), np.array([4.0]))
    assert found.stationarity == 3.0
    assert found.primal == 0.0  # s = 3
    assert found.complementarity == 12.0
