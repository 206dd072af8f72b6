"""Tables of cases, the share of them that README's line takes, and words of refusals."""

import re

import pytest


def cases(names, table):
    """Parameters of a test: names, as in ``"shape, phi"``, of what a table has under each key."""
    return pytest.mark.parametrize(names, table.values(), ids=table)


def first(count, values):
    """Values of a parameter, of which README's line takes so many; ``.ci/run`` takes all."""
    values = list(values)
    return [*values[:count], *(pytest.param(v, marks=pytest.mark.long) for v in values[count:])]


def parts(count):
    """The numbers of the parts of a test; README's line takes the first part."""
    return first(1, range(count))


def refusal(kind, begins, then=""):
    """An error whose sentence begins so, and then has what a pattern says."""
    return pytest.raises(kind, match=f"^{re.escape(begins)}.*{then}")
