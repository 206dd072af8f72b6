"""The load of a flat patch where nothing tilts: the numbers of docs/artifacts.md."""

import numpy as np
import pytest

import quasistatic_ref as qr
from tests.files.urdf.urdf_texts import collision, inertial, joint, link, robot
from tests.scenes import scene

BOX = link(
    "box", collision('<box size="0.1 0.1 0.04"/>'), inertial("0.4", ("3.9e-4", "3.9e-4", "6.7e-4"))
)
SLIDES = robot(
    *(link(name, inertial="") for name in ("o", "lx", "ly", "lz")),
    BOX,
    joint("x", "o", "lx", "prismatic", "1 0 0"),
    joint("y", "lx", "ly", "prismatic", "0 1 0"),
    joint("z", "ly", "lz", "prismatic", "0 0 1"),
    joint("yaw", "lz", "box", "continuous", "0 0 1"),
)
FLAT = (4,)
POINT = 1, 0.3 * 0.0707
"""K and mu_omega [m] of what stands for the patch."""


@pytest.mark.parametrize(
    ("base", "patch", "degrees"),
    [("fixed", FLAT, 0.000), ("floating", FLAT, 4.050), ("fixed", POINT, 6.32)],
)
def test_a_box_that_is_pushed_beside_its_middle(base, patch, degrees):
    text = SLIDES if base == "fixed" else robot(BOX)
    targets = [{"t": t, "base": {"xyz": [x, 0.03, 0.02]}} for t, x in ((0, -0.061), (0.4, -0.048))]
    finger = qr.Body.of_shape(
        "f", qr.Sphere(0.01), 0.1, xyz=(-0.061, 0.03, 0.02), actuated=["base"]
    )
    bodies = {
        "b": qr.Body("b", text, base=base, xyz=(0, 0, 0.02)),
        "f": {"urdf": finger, "K_q": 2000.0, "targets": targets},
    }
    contacts = {"floor": ("floor", "b/box", 0.3, *patch), "push": ("f", "b/box", 0.2, 1)}
    scenario = scene(bodies, contacts, 20, h=0.02, fast=True)
    run = scenario.run(progress=False, findings=False)
    R, _ = scenario.system.pose(run.q[-1], "b/box")
    assert -np.degrees(np.arctan2(R[1, 0], R[0, 0])) == pytest.approx(degrees, abs=0.005)
