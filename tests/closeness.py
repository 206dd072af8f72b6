"""How near what is found has to be to what is expected, entry by entry; rounding, if not said."""

from numpy.testing import assert_allclose, assert_array_equal

from tests.tolerances import ROUNDING


def assert_same(found, expected):
    """Every entry is the one that is expected."""
    __tracebackhide__ = True
    assert_array_equal(found, expected)


def assert_within(found, expected, tolerance=ROUNDING):
    """No entry differs by more than the tolerance, which has the entry's unit."""
    __tracebackhide__ = True
    assert_allclose(found, expected, rtol=0.0, atol=tolerance)


def assert_relative(found, expected, tolerance=ROUNDING):
    """No entry differs by more than this share of what is expected [-]; 0 is found as 0."""
    __tracebackhide__ = True
    assert_allclose(found, expected, rtol=tolerance, atol=0.0)


def assert_close(found, expected, tolerance=ROUNDING):
    """No entry differs by more than tolerance * (1 + |expected|): numbers of size one."""
    __tracebackhide__ = True
    assert_allclose(found, expected, rtol=tolerance, atol=tolerance)
