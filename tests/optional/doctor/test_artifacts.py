"""Pi and the boundary layer of a run: the formulas, and the header."""

import numpy as np
import pytest

from quasistatic_ref import Body, Box, Sphere, load_scenario, load_trajectory
from tests.closeness import assert_relative
from tests.files.urdf.urdf_texts import collision, inertial, joint, link, robot
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
    assert "(drag over friction): 0; largest boundary layer: 0 mm" in printed.out
    assert printed.err == ""
    cli(*arguments, "--certify", "off")
    header = load_trajectory(tmp_path / "sphere_spin.npz").header
    expected = 0.01 * H**2 * 4 * 0.01 * 0.3 * G / 8e-5
    assert_relative(header.largest_boundary_layer, expected, 3e-3)
    assert 0 < header.quasi_dynamic_number < 0.1


def panel(kind, axis, mass, size, centre=0.0):
    """A box on one joint, whose friction is 1 N or 1 N m, 0.5 m above the ground."""
    at = f'<origin xyz="{centre} 0 0"/>'
    moments = [mass * (a * a + b * b) / 12 for a, b in (size[1:], size[::2], size[:2])]
    weight = inertial(str(mass), map(repr, moments), at)
    shape = collision(f'<box size="{" ".join(map(str, size))}"/>', at)
    text = robot(link("w"), link("box", shape, weight), joint("j", "w", "box", kind, axis))
    return {"urdf": text, "pose": {"xyz": [0, 0, 0.5]}, "joint_friction": {"j": 1.0}}


V = 0.1
"""Speed of the finger [m/s]."""
CUBE = (0.1, 0.1, 0.1)
CART = Body.of_shape("d", Box(size=CUBE), 4.0, base="planar", xyz=(0, 0, 0.5))
BEHIND = (-0.06, 0.0, 0.5), (1.0, 0.0, 0.0)
PUSHED = {
    # what: where the finger starts and its way; its force slowly, and the drag on it [N]
    "a drawer": (panel("prismatic", "1 0 0", 5, CUBE), BEHIND, 1.0, 5 * V / H),
    "a drawer backwards": (panel("prismatic", "-1 0 0", 5, CUBE), BEHIND, 1.0, 5 * V / H),
    # I = m w^2 / 3, pushed at 0.7 m: I v / (0.7^2 h), which rounds off as the door turns.
    "a door": (
        panel("revolute", "0 0 1", 20, (0.8, 0.02, 1), 0.4), ((0.7, -0.02, 0.5), (0.0, 1.0, 0.0)),
        1 / 0.7, (20 * (0.8**2 + 0.02**2) / 12 + 20 * 0.4**2) * V / H / 0.7**2,
    ),
    "a cart": (CART, BEHIND, 0.0, 4 * V / H),
}  # fmt: skip


@pytest.mark.parametrize("fingers", [1, 2])
@pytest.mark.parametrize("what", PUSHED)
def test_drag_of_what_joints_guide_is_borne_by_the_power_of_what_pushes_it(what, fingers):
    """A door's lever changes by up to 2 % on its way. Two fingers beside each other bear halves."""
    body, (start, way), slowly, drag = PUSHED[what]
    bodies = {"d": body}
    contacts = {}
    for k in range(fingers):
        at = np.add(start, [0.0, 0.0, 0.03 * k - 0.015 * (fingers - 1)])
        ways = [{"t": t, "base": {"xyz": at + t * V * np.array(way)}} for t in (0.0, 0.8)]
        finger = Body.of_shape("f", Sphere(0.01), 0.1, xyz=at, actuated=["base"])
        K = {"base": [1e5, 1e5, 1e5, 1e4, 1e4, 1e4]}
        bodies[f"f{k}"] = {"body": finger, "K_q": K, "targets": ways}
        contacts[f"p{k}"] = {"alpha": f"f{k}", "beta": "d/*", "mu_v": 0.0, "rows": 4}
    scene = {"h": H, "steps": 40, "bodies": bodies, "contacts": contacts, "shapes": {}}
    run = load_scenario(scene, fast=True, certify="off").run(progress=False)
    (found,) = run.findings
    assert found.name == "artifact"
    assert found.numbers["drag_N"] == pytest.approx(drag / fingers, rel=0.02)
    assert found.numbers["slowly_N"] == pytest.approx(slowly / fingers, rel=0.02, abs=1e-6)
