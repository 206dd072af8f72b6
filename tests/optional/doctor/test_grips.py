"""How open a grip is."""

import numpy as np
import pytest

from quasistatic_ref.optional.doctor.frame.start import least_mean
from tests.tolerances import CLOSED_FORM


@pytest.mark.parametrize("fingers", [2, 3, 5])
def test_a_grip_is_as_open_as_its_normals_have_in_common(fingers):
    """Normals about the axis z that have 0.3 or 0.6 along it."""
    angle = 2 * np.pi * np.arange(fingers) / fingers
    for along in (0.3, 0.6):
        across = np.sqrt(1 - along**2)
        n = [across * np.cos(angle), across * np.sin(angle), np.full(fingers, along)]
        assert abs(least_mean(np.transpose(n)) - along) < CLOSED_FORM
