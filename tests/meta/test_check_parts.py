"""The check that takes optional parts away has every part that can go."""

from tests.meta.layers import OPTIONAL
from validation.tools import check_parts


def test_every_part_is_in_the_table():
    assert {f"optional/{name}" for name in check_parts.PARTS} == set(OPTIONAL)
