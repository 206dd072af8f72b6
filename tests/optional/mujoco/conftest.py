"""What the tests of MuJoCo scenes share."""

import pytest


@pytest.fixture
def compiled_here(monkeypatch):
    """The command compiles files in the process of the test."""
    from quasistatic_ref.files.urdf.file import MOST_LINKS
    from quasistatic_ref.optional.mujoco import compiler
    from quasistatic_ref.optional.mujoco.compilation import answer  # which needs MuJoCo

    most = MOST_LINKS, compiler.LARGEST_MODEL
    monkeypatch.setattr(compiler, "printed", lambda path: answer(str(path), *most))
