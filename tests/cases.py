"""Tables of cases, each with its name."""

import pytest


def cases(names, table):
    """Parameters of a test: names, as in ``"shape, phi"``, of what a table has under each key."""
    return pytest.mark.parametrize(names, table.values(), ids=table)
