"""A step that tests of solvers share."""

import pytest

from tests.helpers import planted_step


@pytest.fixture
def step(rng):
    """A step made around its own optimum."""
    return planted_step(rng)[0]
