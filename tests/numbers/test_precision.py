"""The precision of FLINT, which all threads of a process share."""

import math
from fractions import Fraction as F
from threading import Thread

import pytest
from flint import arb, ctx

from quasistatic_ref.numbers.precision import nearest, working_precision
from quasistatic_ref.optional.gap import nearest_in


def test_a_precision_lasts_until_its_block_ends_whatever_other_threads_ask_for():
    before = ctx.prec
    reached = []

    def ask():
        with working_precision(300):
            reached.append(ctx.prec)

    with working_precision(200):
        other = Thread(target=ask)
        other.start()
        other.join(0.05)
        with working_precision(100):
            assert ctx.prec == 100
        assert ctx.prec == 200
        assert reached == []
    other.join()
    assert reached == [300]
    assert ctx.prec == before


LEAST = F(5e-324)
ULP = F(2) ** -52


@pytest.mark.parametrize(
    ("exact", "rounded"),
    [
        (F(0), 0.0),
        (LEAST / 2, 0.0),  # half-way, even is zero
        (LEAST / 2 + LEAST / 2**80, 5e-324),
        (3 * LEAST / 2, 1e-323),  # half-way, even is two units
        (1 + ULP / 2, 1.0),
        (1 + 3 * ULP / 2, 1 + 2 * 2.0**-52),
        (1 + ULP / 2 + F(1, 10**60), 1 + 2.0**-52),
        (F(2) ** 1024, math.inf),
        (F(1, 3), 1 / 3),
    ],
)
def test_nearest_rounds_half_to_even_and_never_to_minus_zero(exact, rounded):
    for sign in (1, -1):
        found = nearest(sign * exact.numerator, exact.denominator)
        assert found == sign * rounded
        assert found != 0 or math.copysign(1, found) == 1


def test_ball_is_rounded_only_where_all_its_numbers_agree():
    with working_precision(200):
        third = arb(1) / 3
        assert nearest_in(third) == 1 / 3
        assert nearest_in(third - third) is None  # a hidden zero
        assert nearest_in(arb(0)) == 0.0
        half_way = 1 + arb(2) ** -53
        assert nearest_in(half_way) == 1.0
        assert nearest_in(half_way + third - third) is None
        assert nearest_in(arb.nan()) is None
        assert nearest_in(arb(1) / arb(0)) is None
