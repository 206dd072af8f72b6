"""Pi and the boundary layer of a run: the formulas, and the header."""

import numpy as np
import pytest

from quasistatic_ref import Box, Sphere, load_trajectory
from tests.closeness import assert_relative
from tests.optional.words import driven, placed, slides, solid
from tests.scenes import scene

H = 0.01
G = 9.81
STIFF = 1e6
"""Of the tray's springs [N/m]."""


@pytest.mark.parametrize(("mu_v", "g"), [(0.5, G), (0.0, G), (0.5, 0.0)])
def test_pi_is_the_drag_over_the_friction_that_the_contacts_can_bear(mu_v, g):
    """A tray takes it along at 10 mm/s; a ball with more friction stands on it.

    In the first step the tray's springs K give way, by e = M / h^2 / (K + M / h^2) of what is to
    move: along to 1 kg and 2/7 of the ball, which rolls, and down to 1.1 kg. Without weight the
    layer alone presses: with N and mu_v N the drag is N sqrt(1 + mu_v^2).
    """
    ways = [{"t": t, "x": 0.01 * t} for t in (0.0, 10.0)]
    slab = slides("xz", '<box size="1 1 0.02"/>')
    tray = driven(slab, (0, 0, -0.01), {"x": STIFF, "z": STIFF}, ways)
    box, ball = solid(1.0, Box(size=(0.1,) * 3)), solid(0.1, Sphere(0.05))
    bodies = {"tray": tray, "b": placed(box, (0, 0, 0.05), base="floating")}
    bodies["ball"] = placed(ball, (0, 0.3, 0.05), base="floating")
    contacts = {"b": ("tray/tip", "b", mu_v, 4), "ball": ("tray/tip", "ball", 2 * mu_v, 1)}
    run = scene(bodies, contacts, 20, H, gravity=[0, 0, -g]).run(progress=False)
    Pi = run.header.quasi_dynamic_number
    if not mu_v:
        assert Pi is None
    elif g:
        stiff = np.array([1 + 0.2 / 7, 1.1]) / H**2
        along, down = stiff / (STIFF + stiff)
        drag = np.hypot((1 - along) * 0.01 / H, down * g)
        assert Pi == pytest.approx(drag / (mu_v * (1 - down) * g), rel=1e-6)
    else:
        assert Pi == pytest.approx(np.hypot(1.0, mu_v) / mu_v, rel=1e-6)


def test_a_run_tells_its_numbers_and_keeps_them_in_its_header(tmp_path, cli):
    # Until t = 0.4 s the sphere sticks: neither speed nor layer. At the end it turns at
    # (tau - mu m g) h / I = 14.7 rad/s and rises by mu_omega h omega = 1.47 mm.
    arguments = ["run", "sphere_spin", "--out", tmp_path]
    printed = cli(*arguments, "--set", "steps=39")
    assert "(drag over friction): 0; largest boundary layer: 0 um" in printed.out
    assert printed.err == ""
    cli(*arguments, "--certify", "off")
    header = load_trajectory(tmp_path / "sphere_spin.npz").header
    expected = 0.01 * H**2 * 4 * 0.01 * 0.3 * G / 8e-5
    assert_relative(header.largest_boundary_layer, expected, 3e-3)
    assert 0 < header.quasi_dynamic_number < 0.1
