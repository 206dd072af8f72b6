import numpy as np
import pytest

from quasistatic_ref.optional.doctor.telling import rounded


@pytest.mark.parametrize("factor", [1.0, 1 + 1e-14, 1 - 1e-14])
def test_two_digits_are_beyond_a_limit_whatever_its_last_bits(factor):
    assert rounded(7.5 * factor, np.ceil) == pytest.approx(7.6)
    assert rounded(2e4 * factor, np.floor) == pytest.approx(1.9e4)
    assert rounded(0.00031 * factor, np.floor) == pytest.approx(0.0003)


def test_a_third_digit_is_rounded_to_the_safe_side():
    assert rounded(7.51, np.ceil) == pytest.approx(7.6)
    assert rounded(7.59, np.floor) == pytest.approx(7.5)
