"""A scene of a System, and a scenario with lines replaced, that some tests share."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

from quasistatic_ref.model.system import System
from quasistatic_ref.simulate.scenario import Scenario, load_scenario
from tests.scenes import PUSH, chain_scene, written_scenario


@pytest.fixture
def scene(tmp_path: Path) -> System:
    """A floating arm, actuated in part; a fixed one on a tilted desk; a free box."""
    return chain_scene(tmp_path)


@pytest.fixture
def q(scene: System, rng: np.random.Generator) -> np.ndarray:
    """A configuration without symmetries."""
    return scene.integrate(scene.neutral(), rng.normal(size=scene.n_v))


@pytest.fixture
def load(tmp_path: Path) -> Callable[..., Scenario]:
    """The scenario PUSH with some of its lines replaced."""

    def loaded(*changes: tuple[str, str], settings: Sequence[str] = ()) -> Scenario:
        text = PUSH
        for old, new in changes:
            assert text.count(old) == 1, old
            text = text.replace(old, new)
        return load_scenario(written_scenario(tmp_path, text), settings)

    return loaded
