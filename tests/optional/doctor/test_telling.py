import pytest

from quasistatic_ref.optional.doctor.texts import distance, length


@pytest.mark.parametrize(
    ("x", "words"),
    [(4e-6, "0 mm"), (-0.0123, "12.3 mm"), (0.9994, "999 mm"), (0.9996, "1 m"), (50.0, "50 m")],
)
def test_a_length_is_in_millimetres_until_it_is_long(x, words):
    assert length(x) == words


@pytest.mark.parametrize(("x", "words"), [(4e-6, "0.004 mm"), (1.23456, "1.235 m")])
def test_a_distance_is_said_however_short_and_as_a_remedy_needs_it(x, words):
    assert distance(x, 4) == words
