"""Configurations from outside: unit parts of length one, zeros without a sign."""

import numpy as np
import pytest

from quasistatic_ref import ModelError
from quasistatic_ref.model.configuration import (
    UnitParts,
    configuration,
    normalised,
    surely_configurations,
    unit_configuration,
)
from quasistatic_ref.model.joints.axis_joint import Revolute
from quasistatic_ref.model.joints.continuous import Continuous
from quasistatic_ref.model.joints.floating import Floating
from quasistatic_ref.model.joints.planar import Planar

JOINTS = (
    Floating("box/base", False, slice(0, 7), slice(0, 6)),
    Planar("puck/base", False, slice(7, 11), slice(6, 9)),
    Continuous("arm/spin", False, slice(11, 13), slice(9, 10)),
    Revolute("arm/swing", False, slice(13, 14), slice(10, 11)),
)
UNITS = {"quaternion": slice(3, 7), "heading": slice(9, 11), "turn": slice(11, 13)}
# Lengths that are whole numbers, entry by entry: (3, 4) has 5, (5, 12) has 13, (13, 84) has 85, and
# (8, 15) has 17. So nothing is rounded, whichever library computes them.
Q = np.array([5, 6, 7, 3, 4, 12, 84, 8, 9, 3, 4, 8, 15, 0.5], dtype=np.float64)


@pytest.fixture
def q():
    """Q as a configuration."""
    return normalised(JOINTS, Q)


def as_configuration(q):
    return configuration(JOINTS, len(Q), q)


def test_quaternions_and_cosine_sine_pairs_are_divided_by_their_lengths():
    quaternion = [3 / 85, 4 / 85, 12 / 85, 84 / 85]
    expected = [5, 6, 7, *quaternion, 8, 9, 3 / 5, 4 / 5, 8 / 17, 15 / 17, 0.5]
    q = Q.copy()
    assert normalised(JOINTS, q).tolist() == expected
    assert np.array_equal(q, Q)


def test_lengths_off_by_rounding_alone_keep_their_bits(q):
    q[UNITS["quaternion"]] = [0.0, 0.0, 0.0, 1.0 + 2.0**-52]
    q[UNITS["turn"]] = [1.0 - 2.0**-53, 0.0]
    assert np.array_equal(normalised(JOINTS, q), q)
    assert np.array_equal(as_configuration(q), q)


def test_a_configuration_has_no_negative_zeros(q):
    q[:3] = q[-1] = -0.0
    for found in (normalised(JOINTS, q), as_configuration(q)):
        assert np.array_equal(found, q)
        assert not np.signbit(found).any()


def test_only_the_quaternion_w_x_y_z_of_no_turn_is_taken_for_one_of_that_order(q):
    half_turns = np.eye(4)[1:]
    for half_turn in half_turns:
        q[UNITS["quaternion"]] = half_turn
        assert np.array_equal(as_configuration(q), q)
    q[UNITS["quaternion"]] = [1.0, 0.0, 0.0, 0.0]
    with pytest.raises(ModelError, match=r"looks like the identity as \[w x y z\]"):
        as_configuration(q)


def test_the_length_that_is_refused_is_named_with_its_remedy(q):
    UnitParts(JOINTS).check(q)
    q[UNITS["quaternion"]] *= 2
    words = (
        r"q\[box/base\]: its quaternion must have length one, not 2; "
        r"system.normalised\(q\) divides it by its length"
    )
    for refusing in (UnitParts(JOINTS).check, as_configuration):
        with pytest.raises(ModelError, match=words):
            refusing(q)
    assert np.allclose(unit_configuration(JOINTS, len(q), q), normalised(JOINTS, Q), atol=1e-15)


@pytest.mark.parametrize(
    ("entries", "values", "sure"),
    [
        (slice(0, 3), [-0.0, 1e9, 1.0], True),
        (UNITS["quaternion"], [0.0, 0.0, 0.0, 1 - 2.0**-53], True),
        (UNITS["quaternion"], [1.0, 0.0, 0.0, 0.0], False),  # refused
        (UNITS["heading"], [1 + 2.0**-31, 0.0], False),  # divided by its length
        (slice(13, 14), [np.nan], False),
    ],
)
def test_only_what_would_keep_its_bits_is_surely_a_configuration(q, entries, values, sure):
    one = q.copy()
    one[entries] = values
    for every in (one, np.array([q, one, q])):
        assert surely_configurations(JOINTS, every) == sure
    if sure:
        assert np.array_equal(as_configuration(one), one)


def test_a_part_of_length_zero_has_no_direction(q):
    q[UNITS["turn"]] = 0
    with pytest.raises(ModelError, match=r"q\[arm/spin\]: its \(cos, sin\) must not have length 0"):
        unit_configuration(JOINTS, len(q), q)
