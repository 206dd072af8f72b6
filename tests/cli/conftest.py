"""A small scenario, and a folder for what commands write."""

import pytest

from tests.scenes import written_scenario


@pytest.fixture
def scene(tmp_path):
    return written_scenario(tmp_path)


@pytest.fixture
def out(tmp_path):
    return tmp_path / "out"
