"""Tables of cases, each with its name, and what is said of those that are refused."""

import re

import pytest


def cases(names, table):
    """Parameters of a test: names, as in ``"shape, phi"``, of what a table has under each key."""
    return pytest.mark.parametrize(names, table.values(), ids=table)


def refusal(kind, begins, then=""):
    """An error whose sentence begins so, and then has what a pattern says."""
    return pytest.raises(kind, match=f"^{re.escape(begins)}.*{then}")
