"""The scene that the tests of System share."""

from pathlib import Path

import numpy as np
import pytest

from quasistatic_ref.model.system import Body, System
from tests.unit.urdf_texts import BOX, CHAIN, written


@pytest.fixture
def scene(tmp_path: Path) -> System:
    """A floating arm, actuated in part; a fixed one on a tilted desk; a free box."""
    chain, box = written(tmp_path, CHAIN, "chain.urdf"), written(tmp_path, BOX, "box.urdf")
    return System(
        [
            Body("box", box, "floating", xyz=(0.5, 0.6, 0.7), rpy=(0.1, 0.2, 0.3)),
            Body("arm", chain, "floating", ("spin", "base"), positions={"spin": 2.0}),
            Body("desk", chain, "fixed", ("slide",), xyz=(1, 2, 3), rpy=(0.4, -0.5, 0.6)),
        ]
    )


@pytest.fixture
def q(scene: System, rng: np.random.Generator) -> np.ndarray:
    """A configuration without symmetries."""
    return scene.integrate(scene.neutral(), rng.normal(size=scene.n_v))
