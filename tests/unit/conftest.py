"""The scene that the tests of System share."""

from pathlib import Path

import numpy as np
import pytest

from quasistatic_ref.model.system import System
from tests.scenes import chain_scene


@pytest.fixture
def scene(tmp_path: Path) -> System:
    """A floating arm, actuated in part; a fixed one on a tilted desk; a free box."""
    return chain_scene(tmp_path)


@pytest.fixture
def q(scene: System, rng: np.random.Generator) -> np.ndarray:
    """A configuration without symmetries."""
    return scene.integrate(scene.neutral(), rng.normal(size=scene.n_v))
