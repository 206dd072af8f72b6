"""Numbers of the vectors: rational or balls, rounded correctly."""

from math import nextafter

import pytest
from flint import arb, fmpq

from quasistatic_ref.lab.vectors.exact.precision import (
    Undecided,
    rounded_results,
    sign,
)

NEXT = nextafter(1.0, 2.0)
"""1 + 2^-52."""


def test_midpoints_between_two_floats_go_to_the_even_one_but_for_a_hair():
    # 1 + 2^-53 lies between 1 (even) and 1 + 2^-52 (odd); 1 + 3 2^-53 between that and 1 + 2^-51.
    below = fmpq(1) + fmpq(1, 1 << 53)
    above = fmpq(1) + fmpq(3, 1 << 53)
    hair = fmpq(1, 10**60)
    values, _ = rounded_results(lambda: [below, above, below - hair, below + hair])
    assert values == [1.0, nextafter(NEXT, 2.0), 1.0, NEXT]


def test_precision_is_raised_until_the_ball_decides():
    # 2^300 pi + 1 - 2^300 pi: at 320 bits nothing of the 1 is sure, at 640 it is.
    huge = fmpq(2) ** 300
    values, _ = rounded_results(lambda: [(arb.pi() * huge + 1) - arb.pi() * huge])
    assert values == [1.0]


def test_a_small_ball_around_zero_is_zero_and_never_minus_zero():
    values, digits = rounded_results(
        lambda: [arb.pi() - arb.pi(), arb(0, 1) * arb(2) ** -201, fmpq(0)]
    )
    assert [str(value) for value in values] == ["0.0"] * 3
    assert digits == ["0." + "0" * 29 + "e+00"] * 3


def test_a_wide_ball_has_no_sign():
    with pytest.raises(Undecided):
        sign(arb(0, 1) * arb(2) ** -100)


def test_a_ball_made_before_is_refused():
    early = arb.pi()  # at the precision of nobody's asking, 53 bits
    with pytest.raises(Undecided):
        rounded_results(lambda: [early])
