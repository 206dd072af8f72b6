import numpy as np
import pytest

from quasistatic_ref.optional.doctor.telling import distance, length, rounded


@pytest.mark.parametrize("factor", [1.0, 1 + 1e-14, 1 - 1e-14])
def test_two_digits_are_beyond_a_limit_whatever_its_last_bits(factor):
    assert rounded(7.5 * factor, np.ceil) == pytest.approx(7.6)
    assert rounded(2e4 * factor, np.floor) == pytest.approx(1.9e4)
    assert rounded(0.00031 * factor, np.floor) == pytest.approx(0.0003)


def test_a_third_digit_is_rounded_to_the_safe_side():
    assert rounded(7.51, np.ceil) == pytest.approx(7.6)
    assert rounded(7.59, np.floor) == pytest.approx(7.5)


@pytest.mark.parametrize(
    ("x", "words"),
    [(4e-6, "0 mm"), (-0.0123, "12.3 mm"), (0.9994, "999 mm"), (0.9996, "1 m"), (50.0, "50 m")],
)
def test_a_length_is_in_millimetres_until_it_is_long(x, words):
    assert length(x) == words


@pytest.mark.parametrize(("x", "words"), [(4e-6, "0.004 mm"), (1.23456, "1.235 m")])
def test_a_distance_is_said_however_short_and_as_a_remedy_needs_it(x, words):
    assert distance(x, 4) == words
