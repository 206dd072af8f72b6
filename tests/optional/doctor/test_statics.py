"""What is missing, and what drag, layer and corners change: each number by hand."""

import numpy as np
import pytest

import quasistatic_ref as qr

G = 9.81
FLOOR = {"floor": qr.HalfSpace((0, 0, 1), 0.0)}


def box(name, half, m, xyz, **more):
    return qr.Body.of_shape(name, qr.Box(half), mass=m, xyz=xyz, **more)


def cube(name="b", m=1.0, xyz=(0, 0, 0.05), **more):
    return box(name, (0.05, 0.05, 0.05), m, xyz, **more)


def driven(body, K, targets, K_r=1e4):
    """A base on springs K [N/m] and K_r [N m/rad], whose targets are (t, place)."""
    waypoints = [{"t": t, "base": {"xyz": list(p)}} for t, p in targets]
    return {"urdf": body, "K_q": {"base": [*K, K_r, K_r, K_r]}, "targets": waypoints}


def finger(name, xyz, K, targets, K_r=100.0):
    tip = qr.Body.of_shape(name, qr.Sphere(0.01), mass=0.1, xyz=xyz, actuated=["base"])
    return driven(tip, K, targets, K_r)


def plate(K, targets):
    return driven(
        box("p", (0.2, 0.2, 0.01), 0.1, (0, 0, -0.01), actuated=["base"]), [K] * 3, targets
    )


def pair(alpha, beta, mu_v, k=1, mu_omega=None):
    more = {"rows": 4} if mu_omega is None else {"rows": 6, "mu_omega": mu_omega}
    return {"alpha": alpha, "beta": beta, "mu_v": mu_v, "k": k, **more}


def found(bodies, contacts, steps, h=0.01, **more):
    scene = {"h": h, "steps": steps, "fast": True, "bodies": bodies, "contacts": contacts, **more}
    run = qr.load_scenario(scene).run(progress=False)
    return {
        finding.name: finding.numbers
        for finding in run.findings
        if finding.name != "uncertain forces"
    }


def grip(N, steps, way, tables=(("l", "r"),), wrenches=(), h=0.01, K=1e3):
    b = {
        "urdf": cube(xyz=(0, 0, 1)),
        "wrenches": [{"t": t, "force": [0, 0, f]} for t, f in wrenches],
    }
    bodies = {"b": b if wrenches else b["urdf"]}
    for n, s in (("l", -1), ("r", 1)):
        targets = [(t, (s * (0.06 - N / K), 0, z)) for t, z in way]
        bodies[n] = finger(n, (s * 0.06, 0, 1), [K, 1e5, 1e5], targets)
    contacts = {f"c{i}": pair(list(of), "b", 0.5, mu_omega=0.01) for i, of in enumerate(tables)}
    return found(bodies, contacts, steps, h)


@pytest.mark.parametrize("v", [0.1, 0.0])
def test_what_a_grip_lacks_is_seen_behind_a_fast_lift(v):
    """2 x 25 N hold 25 N; 20 N are added to the weight in the last three steps."""
    way = [(0, 1), (0.1, 1), (0.5, 1 + 0.4 * v)]
    numbers = grip(25.0, 63, way, wrenches=((0, 0), (0.6, 0), (0.61, -20)))
    lacks = numbers["not in equilibrium"]["missing_N"]
    assert lacks == pytest.approx(G + 20 - 25, rel=1e-2)


@pytest.mark.parametrize("tables", [(("l", "r"),), (("l",), ("r",))])
def test_a_grip_is_lost_whatever_its_tables(tables):
    assert "lost grip" in grip(5.0, 60, [(0, 1), (0.1, 1), (0.6, 1.05)], tables)


def test_friction_of_a_lift_is_that_of_the_weight_without_drag():
    """2 x 20 N lift 1 kg at 50 mm/s: (m g + m v / h) / 2 = 7.4 N a finger for 4.9 N."""
    numbers = grip(20.0, 60, [(0, 1), (0.1, 1), (0.6, 1.025)])["drag"]
    assert numbers["friction_N"] == pytest.approx((G + 5) / 2, rel=1e-2)
    assert numbers["without_drag_N"] == pytest.approx(G / 2, rel=1e-3)


def test_drag_of_a_tray_is_that_of_all_that_it_carries():
    """1 kg and on it 0.5 kg at 60 mm/s, h = 20 ms: 1.5 kg 60 mm/s / 20 ms = 4.5 N."""
    bodies = {
        "p": plate(1e5, [(0, (0, 0, -0.01)), (1, (0.06, 0, -0.01))]),
        "a": cube("a"),
        "b": cube("b", 0.5, (0, 0, 0.15)),
    }
    contacts = {"t": pair("p", "a", 0.5, 4), "u": pair("a", "b", 0.5, 4)}
    numbers = found(bodies, contacts, 10, 0.02)["drag"]
    assert numbers["friction_N"] == pytest.approx(4.5, rel=1e-2)
    assert numbers["without_drag_N"] < 0.01


def bar(N, m, d, mu_v, mu_omega, steps, h, way, force=(0, 0, 0), K=1e3, cone="pyramid"):
    """A bar that two fingers hold d [m] beside its centre, with N each."""
    urdf = box("b", (0.15, 0.01, 0.01), m, (d, 0, 1))
    bodies = {"b": {"urdf": urdf, "wrenches": [{"t": 0, "force": list(force)}]}}
    for n, s in (("l", -1), ("r", 1)):
        targets = [(t, (0, s * (0.02 - N / K), z)) for t, z in way]
        bodies[n] = finger(n, (0, s * 0.02, 1), [1e5, K, 1e5], targets, 1e4)
    contacts = {"c": pair(["l", "r"], "b", mu_v, mu_omega=mu_omega)}
    return found(bodies, contacts, steps, h, cone=cone)


@pytest.mark.parametrize("h", [0.02, 0.005])
def test_what_drag_turns_is_named(h):
    """It needs m (g + v/h) (1/mu_v + d/mu_omega) / 2 <= N: h >= 29 ms; at rest 3.92 < 4.2 N."""
    names = bar(4.2, 0.2, 0.04, 0.5, 0.02, round(1.2 / h), h, [(0, 1), (1, 1.02)])
    assert {"drag", "not in equilibrium"} & names.keys() == {"drag"}


@pytest.mark.parametrize("fx", [0.0, 0.05, 0.2])
def test_a_bar_that_turns_in_its_grip_lacks_what_its_first_acceleration_says(fx):
    """Slip and spin go along a face of the pyramid, and nothing bears fx."""
    m, d, mu, w, N = 0.44, 0.04, 0.4, 0.01, 8.0
    inertia, c, W = m / 3 * (0.15**2 + 0.01**2), d + w / mu, m * G + 0.7
    turns = (W * c - 2 * w * N) / (inertia + m * c * c)
    numbers = bar(N, m, d, mu, w, 1, 0.01, [(0, 1)], (fx, 0, -0.7))["not in equilibrium"]
    assert numbers["missing_Nm"] == pytest.approx(inertia * turns, rel=1e-2)
    assert numbers["missing_N"] == pytest.approx(np.hypot(m * c * turns, fx), rel=1e-2)


def wiper(way, steps, K=2e4):
    bodies = {"f": finger("f", (0, 0, 0.01), [1e5, 1e5, K], way), "b": cube(xyz=(0, 1, 0.05))}
    contacts = {"w": pair("floor", "f", 0.5), "g": pair("floor", "b", 0.5, 4)}
    return found(bodies, contacts, steps, shapes=FLOOR)


@pytest.mark.parametrize("up", [0.0105, 0.01023])
def test_a_layer_is_seen_though_it_lifts_off_obliquely(up):
    """N = K (e + mu_v h v) = 10 N for 5 N in 30 steps."""
    z = 0.01 - 0.25e-3
    way = [
        (0, (0, 0, z)),
        (0.3, (0.015, 0, z)),
        (0.31, (0.0155, 0, up)),
        (0.32, (0.016, 0, 0.0105)),
    ]
    numbers = wiper(way, 32)["boundary layer"]
    assert numbers["normal_N"] == pytest.approx(10.0, rel=1e-2)
    assert numbers["coulomb_N"] == pytest.approx(5.0, rel=1e-2)


def test_what_spins_without_sliding_rises_by_its_torsion():
    """N = K (e + mu_omega h omega) = 8 N for 5 N."""
    tip = qr.Body.of_shape("w", qr.Sphere(0.01), mass=0.1, xyz=(0, 0, 0.01), actuated=["base"])
    way = [{"t": t, "base": {"xyz": [0, 0, 0.005], "rpy": [0, 0, 3 * t]}} for t in (0.0, 1.0)]
    w = {"urdf": tip, "K_q": {"base": [1e5, 1e5, 1e3, 1e3, 1e3, 1e3]}, "targets": way}
    scene = {"h": 0.05, "steps": 15, "fast": True, "bodies": {"w": w}, "shapes": FLOOR}
    contacts = {"s": pair("floor", "w", 0.0, mu_omega=0.02)}
    (finding,) = qr.load_scenario(scene | {"contacts": contacts}).run(progress=False).findings
    assert finding.numbers["normal_N"] == pytest.approx(8.0, rel=1e-2)
    assert "what spins rises by mu_omega h omega, against" in finding.cause


def test_a_layer_that_follows_from_drag_is_named_after_drag():
    """2 x 12 N, mu_v 0.5, 50 mm/s: drag makes it slip, and what slips rises; slowly it sticks."""
    names = grip(12.0, 30, [(0, 1), (0.05, 1), (1.05, 1.05)], K=1e6)
    assert {"drag", "boundary layer"} & names.keys() == {"drag"}


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


def test_a_lid_on_a_hinge_lacks_a_torque():
    body = qr.Body("d", HINGED, actuated=["s"], xyz=(0, 0, 0.5))
    bodies = {"d": {"urdf": body, "K_q": {"s": 1e4}, "targets": [{"t": 0, "s": 0.0}]}}
    numbers = found(bodies, {"g": pair("floor", "d/lid", 0.5, 4)}, 1, shapes=FLOOR)
    lacks = numbers["not in equilibrium"]
    assert lacks["missing_Nm"] == pytest.approx(0.1 * G * 0.1, rel=1e-6)
    assert lacks["missing_N"] == 0.0


def test_a_planar_body_lacks_a_force():
    """6 N on a support that bears mu_v m g = 3.924 N."""
    b = {
        "urdf": cube(base="planar"),
        "support": {"mu_v": 0.4},
        "wrenches": [{"t": 0, "force": [6, 0, 0]}],
    }
    bodies = {"b": b, "x": cube("x", xyz=(1, 0, 0.05))}
    numbers = found(bodies, {"f": pair("floor", "x", 0.5, 4)}, 3, shapes=FLOOR)
    assert numbers["not in equilibrium"]["missing_N"] == pytest.approx(6 - 0.4 * G, rel=1e-3)


def test_what_falls_through_fingers_is_not_borne_where_it_is():
    """No friction: the most that springs of 100 N/m bear on their way is 0.4 N."""
    c, s = np.cos(np.pi / 6), 0.5
    bodies = {"b": qr.Body.of_shape("b", qr.Sphere(0.05), mass=1.0, xyz=(0, 0, 1))}
    for n, side in (("l", -1), ("r", 1)):
        p = (side * 0.06 * c, 0, 1 - 0.06 * s)
        bodies[n] = finger(n, p, [100.0, 1e5, 1e5], [(0, p)])
    names = found(bodies, {"c": pair(["l", "r"], "b", 0.0)}, 12)
    assert 9.4 < names["not in equilibrium"]["missing_N"] < G


def test_a_box_that_fingers_stroke_is_not_lost():
    bodies = {"b": box("b", (0.2, 0.05, 0.05), 1.0, (0, 0, 0.05))}
    for n, s in (("l", -1), ("r", 1)):
        way = [(0, (-0.1, s * 0.058, 0.05)), (1, (-0.08, s * 0.058, 0.05))]
        bodies[n] = finger(n, (-0.1, s * 0.06, 0.05), [1e5, 1e3, 1e5], way)
    contacts = {"c": pair(["l", "r"], "b", 0.5, mu_omega=0.005), "g": pair("floor", "b", 0.5, 4)}
    assert found(bodies, contacts, 100, shapes=FLOOR) == {}


def test_a_soft_palm_bears_a_box_that_still_sinks():
    """Its spring of 5 N/m gives way by 1.96 m: in step 2 it has no thousandth of the weight."""
    bodies = {"p": plate(5.0, [(0, (0, 0, -0.01))]), "b": cube()}
    assert found(bodies, {"c": pair("p", "b", 0.5, 4)}, 3) == {}
