"""What is missing, and what drag, layer and corners change: each number by hand."""

import numpy as np
import pytest

from quasistatic_ref import Sphere
from tests.optional.doctor.drawn_scenes import BOTH, Draw, G, finger, gripped, plate
from tests.optional.doctor.words import block, driven, free, placed, scene, solid

CUBE = block(1.0, (0.1, 0.1, 0.1))
STANDING = free(CUBE, (0, 0, 0.05))
APART = free(CUBE, (0, 1, 0.05))


def about(value, rel=1e-2, **more):
    """A number by hand."""
    return pytest.approx(value, rel=rel, **more)


def grip(N, steps, *way, K=1e3, loads=(), tables=(BOTH,)):
    """1 kg between fingers that press with N each and go up by a way (t, z)."""
    bodies = gripped(Draw(0), N, 0.1, *((t, z, 1.0) for t, z in way), K=K)
    bodies["b"] = free(CUBE, (0, 0, 0))
    bodies["b"]["wrenches"] += [{"t": t, "force": [0, 0, f]} for t, f in loads]
    return bodies, {f"c{i}": (of, "b", 0.5, 1, 0.01) for i, of in enumerate(tables)}, steps, {}


def lifted_fast():
    """2 x 25 N hold 25 N; 20 N are added to the weight in the last three steps."""
    return grip(25.0, 63, (0.1, 0), (0.5, 0.04), loads=((0.6, 0), (0.61, -20)))


def lost():
    """2 x 5 N hold 5 N of 9.81 N."""
    return grip(5.0, 60, (0.1, 0), (0.6, 0.05), tables=BOTH)


def carried():
    """1 kg and on it 0.5 kg at 60 mm/s, h = 20 ms: 1.5 kg 60 mm/s / 20 ms = 4.5 N."""
    upper = free(block(0.5, (0.1, 0.1, 0.1)), (0, 0, 0.15))
    contacts = {"t": ("p/tip", "a", 0.5, 4), "u": ("a", "b", 0.5, 4)}
    return {"p": plate(1e5, (0.06, 0)), "a": STANDING, "b": upper}, contacts, 10, {"h": 0.02}


def wiper(up):
    """N = K (e + mu_v h v) = 10 N for 5 N in 30 steps; then it goes up."""
    e = -0.25e-3
    way = ((0, 0, e), (0.3, 0.015, e), (0.31, 0.0155, up), (0.32, 0.016, 0.0005))
    targets = [{"t": t, "x": x, "z": z} for t, x, z in way]
    bodies = {"f": finger((0, 0, 0.01), {"z": 2e4}, targets), "b": APART}
    return bodies, {"w": ("floor", "f/tip", 0.5, 1), "g": ("floor", "b", 0.5, 4)}, 32, {}


def spun():
    """N = K (e + mu_omega h omega) = 8 N for 5 N: its torque, mu_omega N, is as much too large."""
    way = [{"t": t, "base": {"xyz": [0, 0, 0.005], "rpy": [0, 0, 3 * t]}} for t in (0.0, 1.0)]
    K_q = {"base": [1e5, 1e5, 1e3, 1e3, 1e3, 1e3]}
    tip = driven(solid(0.1, Sphere(0.01)), (0, 0, 0.01), K_q, way) | {"base": "floating"}
    return {"w": tip}, {"s": ("floor", "w", 0.0, 1, 0.02)}, 15, {"h": 0.05}


HINGED = """<robot name="d"><link name="w"/><link name="base"><inertial><mass value="10"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="lid"><inertial><origin xyz="0.1 0 0"/><mass value="0.1"/>
<inertia ixx="3.3333333e-4" iyy="3.3333333e-4" izz="3.3333333e-4"
ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0.1 0 0"/><geometry><box size="0.2 0.1 0.01"/></geometry></collision></link>
<joint name="s" type="prismatic"><parent link="w"/><child link="base"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1000" velocity="1"/></joint><joint name="hinge" type="revolute">
<parent link="base"/><child link="lid"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="10"
velocity="1"/></joint></robot>"""


def hinged():
    """A lid of 0.1 kg, whose middle is 0.1 m from its hinge."""
    body = driven(HINGED, (0, 0, 0.5), {"s": 1e4}, [{"t": 0, "s": 0.0}])
    return {"d": body}, {"g": ("floor", "d/lid", 0.5, 4)}, 1, {}


def planar():
    """6 N on a support that bears mu_v m g = 3.924 N."""
    load = [{"t": 0, "force": [6, 0, 0]}]
    body = placed(CUBE, (0, 0, 0.05), base="planar", support={"mu_v": 0.4}, wrenches=load)
    return {"b": body, "x": APART}, {"f": ("floor", "x", 0.5, 4)}, 3, {}


def falls_through():
    """No friction: springs of 100 N/m bear 0.4 N at most on their way, and then push as much."""
    bodies = {"b": free(solid(1.0, Sphere(0.05)), (0, 0, 0))}
    for name, side in (("left_x", -1), ("right_x", 1)):
        at = (side * 0.06 * np.cos(np.pi / 6), 0, -0.03)
        bodies[name] = finger(at, {"x": 100.0}, [{"t": 0.0, "x": 0.0}])
    return bodies, {"c": (BOTH, "b", 0.0, 1)}, 12, {}


def stroked():
    """Fingers press with 2 N on a box of 1 kg on a floor, and go along it."""
    bodies = {"b": free(block(1.0, (0.4, 0.1, 0.1)), (0, 0, 0.05))}
    for name, side in (("left_x", -1), ("right_x", 1)):
        way = [{"t": t, "x": 0.02 * t, "y": -0.002 * side} for t in (0.0, 1.0)]
        bodies[name] = finger((-0.1, 0.06 * side, 0.05), {"x": 1e5, "y": 1e3}, way)
    return bodies, {"c": (BOTH, "b", 0.5, 1, 0.005), "g": ("floor", "b", 0.5, 4)}, 100, {}


def sinks():
    """The spring of 5 N/m gives way by 1.96 m: in step 2 it has no thousandth of the weight."""
    return {"p": plate(5.0), "b": STANDING}, {"c": ("p/tip", "b", 0.5, 4)}, 3, {}


def slides():
    """6 N towards 45 degrees, of which friction takes 0.5 m g in all directions of the circle."""
    push = (6 / np.sqrt(2), 6 / np.sqrt(2), 0)
    box = free(CUBE, (0, 0, 0.05), push)
    return {"b": box}, {"c": ("floor", "b", 0.5, 4)}, 20, {"cone": "ellipsoid"}


def lacks(force, rel=1e-2, **more):
    """The force that is missing [N]."""
    return {"equilibrium": {"missing_N": about(force, rel, **more)}}


LAYER = {"artifact": {"run_N": about(10.0), "slowly_N": about(5.0), "layer_N": about(5.0)}}
TORQUE = {"missing_Nm": about(0.1 * G * 0.1, 1e-6), "missing_N": 0.0}
DRAG = {"run_N": about((G + 5) / 2), "slowly_N": about(G / 2, 1e-3), "drag_N": about(2.5)}
OF_A_TRAY = {"run_N": about(4.5), "slowly_N": about(0, abs=0.01)}
NO_LAYER = {"artifact": {"layer_N": about(0.0, abs=1e-3)}}
CASES = {
    "what a grip lacks behind a fast lift": (lifted_fast(), lacks(G + 20 - 25)),
    "a grip of two tables": (lost(), {"lost-grip": {}}),
    "a lift at 50 mm/s": (grip(20.0, 60, (0.1, 0), (0.6, 0.025)), {"artifact": DRAG}),
    "a tray, and all that it carries": (carried(), {"artifact": OF_A_TRAY}),
    "a layer that ends upwards": (wiper(0.0005), LAYER),
    "a layer that ends obliquely": (wiper(0.00023), LAYER),
    "a layer of what spins": (
        spun(),
        {"artifact": {"run_N": about(8.0), "slowly_N": about(5.0)}},
    ),
    # 2 x 12 N at 50 mm/s: drag makes it slip, and what slips rises; slowly it sticks
    "a layer that follows from drag": (grip(12.0, 30, (0.05, 0), (1.05, 0.05), K=1e6), NO_LAYER),
    "a lid on a hinge": (hinged(), {"equilibrium": TORQUE}),
    "a planar body": (planar(), lacks(6 - 0.4 * G, 1e-3)),
    "what falls through fingers": (falls_through(), lacks(G, 0.0, abs=0.4)),
    "a box that fingers stroke": (stroked(), {}),
    "a box that sinks with its palm": (sinks(), {}),
    "a slide in the ellipsoid": (slides(), lacks(6 - 0.5 * G) | {"corners": None}),
}


@pytest.mark.parametrize(("case", "hand"), CASES.values(), ids=CASES)
def test_what_is_said_has_the_numbers_by_hand(case, hand):
    """Of a finding None: it is not said. Without numbers nothing is."""
    *parts, more = case
    run = scene(*parts, fast=True, **more).run(progress=False)
    said = {found.name: found.numbers for found in run.findings}
    said.pop("uncertain-forces", None)
    assert hand or said == {}
    for name, numbers in hand.items():
        assert (name in said) is (numbers is not None)
        assert {key: said[name][key] for key in numbers or ()} == (numbers or {})
