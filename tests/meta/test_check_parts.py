"""The check that takes optional parts away has every part that can go."""

from tests.meta.layers import OPTIONAL, REMAINING
from validation.tools import check_parts


def test_every_part_that_the_core_does_not_import_is_in_the_table():
    core = {file: parts for file, parts in REMAINING.items() if not file.startswith("optional/")}
    imported = set().union(*core.values())
    named = {f"optional/{name}" for name in check_parts.PARTS}
    assert set(OPTIONAL) - imported <= named <= set(OPTIONAL)
