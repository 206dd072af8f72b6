"""Configurations from outside: unit parts of length one, zeros without a sign."""

import numpy as np
import pytest

from quasistatic_ref import Body, Box, ModelError, Sphere, System
from quasistatic_ref.model.configuration import surely_configurations
from tests.cases import cases
from tests.closeness import assert_same, assert_within
from tests.files.urdf.urdf_texts import joint, link, robot

ARM = robot(
    *map(link, "abc"), joint("spin", "a", "b", "continuous"), joint("swing", "b", "c", "revolute")
)
SYSTEM = System([
    Body.of_shape("box", Box((0.1, 0.2, 0.3)), 1.0),
    Body.of_shape("puck", Sphere(0.1), 1.0, base="planar"),
    Body("arm", ARM),
])  # fmt: skip
UNITS = {"quaternion": slice(3, 7), "heading": slice(9, 11), "turn": slice(11, 13)}
# Lengths that are whole numbers, entry by entry: (3, 4) has 5, (5, 12) has 13, (13, 84) has 85, and
# (8, 15) has 17. So nothing is rounded, whichever library computes them.
Q = np.array([5, 6, 7, 3, 4, 12, 84, 8, 9, 3, 4, 8, 15, 0.5], dtype=np.float64)


@pytest.fixture
def q():
    """Q as a configuration."""
    return SYSTEM.normalised(Q)


def test_quaternions_and_cosine_sine_pairs_are_divided_by_their_lengths():
    quaternion = [3 / 85, 4 / 85, 12 / 85, 84 / 85]
    expected = [5, 6, 7, *quaternion, 8, 9, 3 / 5, 4 / 5, 8 / 17, 15 / 17, 0.5]
    q = Q.copy()
    assert SYSTEM.normalised(q).tolist() == expected
    assert_same(q, Q)


def test_lengths_off_by_rounding_alone_keep_their_bits(q):
    q[UNITS["quaternion"]] = [0.0, 0.0, 0.0, 1.0 + 2.0**-52]
    q[UNITS["turn"]] = [1.0 - 2.0**-53, 0.0]
    assert_same(SYSTEM.normalised(q), q)
    assert_same(SYSTEM.checked(q), q)


def test_a_configuration_has_no_negative_zeros(q):
    q[:3] = q[-1] = -0.0
    for found in (SYSTEM.normalised(q), SYSTEM.checked(q)):
        assert_same(found, q)
        assert not np.signbit(found).any()


def test_only_the_quaternion_w_x_y_z_of_no_turn_is_taken_for_one_of_that_order(q):
    for half_turn in np.eye(4)[1:]:
        q[UNITS["quaternion"]] = half_turn
        assert_same(SYSTEM.checked(q), q)
    q[UNITS["quaternion"]] = [1.0, 0.0, 0.0, 0.0]
    with pytest.raises(ModelError, match=r"looks like the identity as \[w x y z\]"):
        SYSTEM.checked(q)


USES = {
    "a state": SYSTEM.at,
    "a check": SYSTEM.checked,
    "links": SYSTEM.kinematics,
    "a sum": lambda q: SYSTEM.integrate(q, np.zeros(SYSTEM.n_v)),
    "a difference": lambda q: SYSTEM.difference(SYSTEM.q_start, q),
}


@pytest.mark.parametrize("length", [0.5, 2])
@cases("use", USES)
def test_a_length_that_is_refused_before_use_is_named_with_its_remedy(q, use, length):
    use(q)
    q[UNITS["quaternion"]] *= length
    words = (
        rf"q\[box/base\]: its quaternion must have length one, not {length}; "
        r"system.normalised\(q\) divides it by its length"
    )
    with pytest.raises(ModelError, match=words):
        use(q)
    assert_within(SYSTEM.normalised(q), SYSTEM.normalised(Q), 1e-15)


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
        assert surely_configurations(SYSTEM.joints, every) == sure
    if sure:
        assert_same(SYSTEM.checked(one), one)


def test_a_part_of_length_zero_has_no_direction(q):
    q[UNITS["turn"]] = 0
    with pytest.raises(ModelError, match=r"q\[arm/spin\]: its \(cos, sin\) must not have length 0"):
        SYSTEM.normalised(q)
