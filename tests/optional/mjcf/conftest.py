"""What the tests of MJCF share."""

import pytest

from quasistatic_ref.optional.mjcf import compiler


@pytest.fixture
def in_this_process(monkeypatch):
    """MuJoCo compiles without a process for each file, for tests that read hundreds."""
    monkeypatch.setattr(compiler, "printed", compiler.answer)
