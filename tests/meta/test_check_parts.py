"""The check that takes optional parts away has every part that can go."""

from tests.meta.layers import OPTIONAL, REMAINING
from validation.tools import check_parts


def test_every_part_is_in_the_table_and_the_core_imports_none():
    assert all(file.startswith("optional/") for file in REMAINING)
    assert {f"optional/{name}" for name in check_parts.PARTS} == set(OPTIONAL)
