"""What a grip that slips or turns lost."""

import numpy as np
import pytest

from quasistatic_ref.optional.doctor.start import least_mean
from tests.files.urdf.urdf_texts import link, robot
from tests.optional.doctor.words import block, driven, fingers, free, scene
from tests.tolerances import CLOSED_FORM


def grip(aside, mu_v, mu_omega, cone="pyramid"):
    """A run in which two fingers press with 3 N each on a bar of 0.2 kg, beside its middle."""
    hand = robot(link("hand", inertial=""), *fingers("hand", 0, 0.02))
    closed = [{"t": 0.0, "left": 0.003, "right": 0.003}]
    bodies = {
        "gripper": driven(hand, (0, 0, 0.3), {"left": 1000, "right": 1000}, closed),
        "bar": free(block(0.2, (0.2, 0.02, 0.03)), (aside, 0, 0.3)),
    }
    contacts = {"grip": ("gripper/*", "bar", mu_v, 1, mu_omega)}
    return scene(bodies, contacts, 100, cone=cone).run(progress=False)


@pytest.mark.parametrize(
    ("aside", "mu_v", "mu_omega", "cone", "remedy", "limit"),
    [
        (0.04, 0.5, 0.02, "pyramid", "raise mu_omega", "mu_omega bears 0.12"),
        (0.0, 0.2, 0.02, "pyramid", "raise mu_v", "its friction bears"),
        (0.04, 2.0, 0.005, "pyramid", "raise mu_omega", "mu_omega bears 0.03"),  # hardly slips
        (0.04, 2.0, 0.005, "ellipsoid", "raise mu_omega", "mu_omega bears 0.03"),
        (0.04, 1.0, None, "pyramid", "raise mu_omega", "mu_omega bears 0 N m"),  # by four rows
        (0.0, 2.0, 0.005, "pyramid", None, ""),
        (0.04, 2.0, 0.05, "pyramid", None, ""),
    ],
)
def test_a_grip_that_is_lost_says_which_limit_was_reached(
    aside, mu_v, mu_omega, cone, remedy, limit
):
    """40 mm beside its middle the bar asks for 0.0785 N m, and mu_omega bears 6 N of it."""
    said = [x for x in grip(aside, mu_v, mu_omega, cone).findings if x.name == "lost-grip"]
    assert [one.remedy.partition(" of ")[0] for one in said] == ([remedy] if remedy else [])
    for one in said:
        assert limit in one.cause
        assert aside == 0 or "presses with 6 N in all" in one.cause  # without the layer
        assert "its friction bears" not in one.cause or aside == 0


@pytest.mark.parametrize("fingers", [2, 3, 5])
def test_a_grip_is_as_open_as_its_normals_have_in_common(fingers):
    """Normals about the axis z that have 0.3 or 0.6 along it."""
    angle = 2 * np.pi * np.arange(fingers) / fingers
    for along in (0.3, 0.6):
        across = np.sqrt(1 - along**2)
        n = [across * np.cos(angle), across * np.sin(angle), np.full(fingers, along)]
        assert abs(least_mean(np.transpose(n)) - along) < CLOSED_FORM
