"""Derivatives of (+) and (-): small turns and half turns."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Body, Sphere, System
from quasistatic_ref.model.joints.continuous import Continuous
from quasistatic_ref.model.joints.floating import Floating
from quasistatic_ref.model.joints.planar import Planar
from quasistatic_ref.optional.derivatives.model.tangent import (
    adjoint,
    difference_rates,
    entry_rates,
    half_turns,
    right_jacobian,
    sum_rates,
)
from tests.closeness import assert_relative, assert_within
from tests.tolerances import DIFFERENCE, FOUR_ULP, ROUNDING

FLOATING = Floating("box/base", False, slice(0, 7), slice(0, 6))
PLANAR = Planar("puck/base", False, slice(0, 4), slice(0, 3))
CONTINUOUS = Continuous("arm/spin", False, slice(0, 2), slice(0, 1))


def test_the_jacobian_of_a_small_turn_keeps_its_second_order():
    # J = 1 - ad / 2 + ad^2 / 6 - ...: of a turn (a, b, 0) row x and column y have a b / 6 alone.
    a = 1e-7
    b = 2e-7
    J = right_jacobian(adjoint(np.array([0, 0, 0, a, b, 0])))
    assert_relative(J[3, 4], a * b / 6, ROUNDING)


@pytest.mark.parametrize("angle", [1e-3, 1.1, 3.0])
def test_the_series_of_a_turn_is_summed_to_its_last_digits(angle):
    # About z: J_xx = J_yy = sin(a) / a, J_xy = -J_yx = (1 - cos(a)) / a = 2 sin(a / 2)^2 / a.
    along = np.sin(angle) / angle
    across = 2 * np.sin(angle / 2) ** 2 / angle
    turn = np.array([[along, across, 0], [-across, along, 0], [0, 0, 1]])
    found = right_jacobian(adjoint(np.array([0, 0, 0, 0, 0, angle])))
    assert_within(found, np.kron(np.eye(2), turn), FOUR_ULP)


@pytest.mark.parametrize("base", ["floating", "planar", "ball"])
@pytest.mark.parametrize("seed", range(5))
def test_r30_sums_and_differences_change_as_written(seed, base):
    """By differences of the screws themselves, turns being below pi."""
    rng = np.random.default_rng(seed)
    system = System([Body.of_shape("b", Sphere(0.1), 1.0, base=base)])
    n = system.n_v
    q, other = (system.integrate(system.neutral(), rng.normal(size=n)) for _ in range(2))
    x, e = rng.normal(size=(2, n))
    e *= 1e-6
    by_q, by_x = sum_rates(system.joints, x)
    end = system.integrate(q, x)
    apart = system.difference(q, other)
    by_start, by_end = difference_rates(system.joints, apart)

    def rate(function):
        return (function(e) - function(-e)) / 2e-6

    moved = rate(lambda t: system.difference(end, system.integrate(system.integrate(q, t), x)))
    changed = rate(lambda t: system.difference(end, system.integrate(q, x + t)))
    first = rate(lambda t: system.difference(system.integrate(q, t), other))
    last = rate(lambda t: system.difference(q, system.integrate(other, t)))
    rates = np.stack([by_q, by_x, by_start, by_end]) @ (e / 1e-6)
    assert_within(rates, [moved, changed, first, last], DIFFERENCE)


HALF = [
    *((FLOATING, axis, 6) for axis in (3, 4, 5)),
    (PLANAR, 2, 3),
    (CONTINUOUS, 0, 1),
]


@pytest.mark.parametrize(("joint", "axis", "n"), HALF)
def test_a_half_turn_about_any_axis_is_named(joint, axis, n):
    for turn, within, named in (
        (np.pi, 0.0, True),
        (-np.pi, 0.0, True),
        (3.0, 0.2, True),  # pi - 3 = 0.14
        (3.0, 0.1, False),
    ):
        change = np.zeros(n)
        change[axis] = turn
        assert half_turns([joint], change, within) == ([joint.name] if named else [])


def test_only_joints_all_of_whose_coordinates_change_can_turn_by_half():
    puck = replace(PLANAR, q=slice(7, 11), v=slice(6, 9))
    change = np.array([0, 0, 0, 0, np.pi, 0, 0, 0, np.pi])
    assert half_turns([FLOATING, puck], change, 0.0) == ["box/base", "puck/base"]
    assert half_turns([FLOATING, puck], change[:6], 0.0) == ["box/base"]


def test_entries_of_a_base_change_as_those_of_its_unit_part():
    """Translations by the rotation R, and (x, w) by its product with (e / 2, 0), at any length."""
    x = np.array([0.3, -1.2, 0.5])
    w = 2.0
    E = entry_rates([FLOATING], np.array([1.0, 2.0, 3.0, *x, w]))
    R = Rotation.from_quat([*x, w]).as_matrix()
    turns = [[*(w * e + np.cross(x, e)) / 2, -x @ e / 2] for e in np.eye(3)]
    assert_within(E[:3], np.hstack([R, np.zeros((3, 3))]), ROUNDING)
    assert_within(E[3:, 3:], np.transpose(turns), ROUNDING)
    # (c, s) = (3, 4): R = (0.6, -0.8; 0.8, 0.6), and (c, s) changes by (-s, c).
    flat = entry_rates([PLANAR], np.array([1.0, 2.0, 3.0, 4.0]))
    expected = [[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, -4], [0, 0, 3]]
    assert_within(flat, expected, ROUNDING)
    assert_within(entry_rates([CONTINUOUS], np.array([3.0, 4.0])), [[-4], [3]], ROUNDING)
