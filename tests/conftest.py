"""Shared fixtures: deterministic random numbers, and Hypothesis the same in every CI run."""

import os

import numpy as np
import pytest
from hypothesis import settings

settings.register_profile("ci", derandomize=True, deadline=None, max_examples=15, database=None)
settings.register_profile("local", deadline=None, max_examples=15)
settings.load_profile("ci" if os.environ.get("CI") else "local")


@pytest.fixture
def rng() -> np.random.Generator:
    """Random numbers, the same in every run."""
    return np.random.default_rng(20231)
