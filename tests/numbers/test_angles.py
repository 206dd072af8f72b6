"""Sines, cosines and angles against 60 digits: correctly rounded."""

import math

import mpmath
import numpy as np

from quasistatic_ref.numbers.angles import angle_of, cos_sin

HARD = (0.0, 5e-324, 1e-310, 1e-8, math.pi / 2, math.pi, 1e22, 1e300, 1.7976931348623157e308)
"""Zero and subnormal numbers, cosines that cancel, and turns of 1,000 bits."""


SMALL = 2.0**-7
"""Up to this angle [rad] compiled code sums a series."""

OPEN = (0.007392019097272012, 0.006694475567248399)
"""Angles whose sine, and whose cosine, is so near to a midpoint that such a series leaves them
open."""

OPEN_VECTOR = (0.0032154004130029454, 0.9221521299603685)
"""(y, x) of an angle for which the same is true."""

LEAST = 2.0**-400
"""Of smaller numbers y the series is not summed, because errors of products underflow."""


def nearest(x):
    """The float64 nearest to a number of mpmath."""
    return float(mpmath.mpf(x))


def small_angles():
    """Angles of both signs up to SMALL [rad]: most of them where the last terms count most."""
    generator = np.random.default_rng(3)
    powers = np.concatenate([generator.uniform(-60, -7, 1500), generator.uniform(-8, -7, 4000)])
    return (generator.choice([-1, 1], powers.size) * 2.0**powers).tolist()


def test_cosine_and_sine_are_the_nearest_float64():
    angles = [*np.random.default_rng(1).normal(scale=10, size=300).tolist()]
    angles += [*small_angles(), *OPEN, SMALL, -SMALL]
    for digits, some in ((700, HARD), (60, angles)):
        with mpmath.workdps(digits):
            expected = [(nearest(mpmath.cos(a)), nearest(mpmath.sin(a))) for a in some]
        assert [cos_sin(a) for a in some] == expected
        assert [*zip(*cos_sin(np.array(some)), strict=True)] == expected


def test_the_angle_of_a_vector_is_the_nearest_float64():
    generator = np.random.default_rng(4)
    tangents = small_angles()
    lengths = generator.uniform(0.5, 2, len(tangents)) * 2.0 ** generator.integers(-2, 5)
    every = [(t * x, x) for t, x in zip(tangents, lengths.tolist(), strict=True)]
    # Numbers whose products underflow or overflow, and quotients that are subnormal.
    every += [OPEN_VECTOR, (3.4808974014242475e-307, 0.3160055184876183), (1e-310, 1e-300)]
    every += [(5e-324, 0.9), (1e290, 1e300)]
    every += [(s * y, x) for y, x in ((LEAST, 0.3), (LEAST / 3, 0.3)) for s in (1, -1)]
    every += np.random.default_rng(2).normal(size=(300, 2)).tolist()
    every += [(0.0, -1.0), (0.0, 1.0), (1.0, 0.0), (5e-324, 1.0), (1e-200, -1e-200), (0.0, 0.0)]
    with mpmath.workdps(60):
        expected = [nearest(mpmath.atan2(*v)) for v in every]
    assert [angle_of(*v) for v in every] == expected
    assert angle_of(*np.array(every).T).tolist() == expected


def test_inf_and_nan_have_no_sine_and_no_angle():
    answers = [*cos_sin(math.inf), *cos_sin(math.nan), angle_of(math.nan, 1.0)]
    assert all(map(math.isnan, answers))
    several = np.array([math.inf, math.nan])
    assert np.isnan([*cos_sin(several), angle_of(several, np.array([math.inf, 1.0]))]).all()


def test_zero_has_the_positive_sign():
    assert all(math.copysign(1, a) == 1 for a in (cos_sin(-0.0)[1], angle_of(-0.0, 1.0)))
