"""What an artifact changes is said with both numbers; where nothing changes, nothing is."""

import numpy as np
import pytest

from quasistatic_ref import load_scenario
from quasistatic_ref.optional.doctor.compared import LookedAt
from tests.optional.doctor.urdfs import ball, block, collision, slides

FLOOR = {"halfspace": {"normal": [0, 0, 1], "offset": 0}}
ARTIFACTS = {"drag", "boundary layer", "corners of the cone", "not in equilibrium"}


def run_of(bodies, contacts, h=0.01, steps=100, floor=FLOOR, **more):
    """A run; of each contact (alpha, beta, mu_v, k)."""
    tables = {
        name: {"alpha": alpha, "beta": beta, "mu_v": mu_v, "rows": 4, "k": k}
        for name, (alpha, beta, mu_v, k) in contacts.items()
    }
    scene = {"h": h, "steps": steps, "bodies": bodies, "contacts": tables, **more}
    if floor:
        scene["shapes"] = {"floor": floor}
    return load_scenario(scene).run(progress=False)


def found(run):
    return [finding for finding in run.findings if finding.name in ARTIFACTS]


def wiper(h, speed=0.05, depth=0.25e-3, mu_v=0.5):
    targets = [{"t": 0.0, "x": 0.0, "z": -depth}, {"t": 1.0, "x": speed, "z": -depth}]
    finger = {
        "urdf": slides("xz", "<sphere radius='0.01'/>"),
        "actuated": ["x", "z"],
        "K_q": {"x": 20000, "z": 20000},
        "pose": {"xyz": [0, 0, 0.01]},
        "targets": targets,
    }
    tables = {"wipe": ("floor", "finger/tip", mu_v, 1)}
    return run_of({"finger": finger}, tables, h=h, steps=round(1 / h))


@pytest.mark.parametrize("h", [0.01, 0.05, 0.1])
def test_what_a_spring_presses_presses_harder_while_it_slides(h):
    """N = K_q (e + mu_v h v), (R13): 10, 30 and 55 N where Coulomb's law has 5."""
    (finding,) = found(wiper(h))
    assert finding.name == "boundary layer"
    np.testing.assert_allclose(
        finding.numbers["normal_N"], 20000 * (0.25e-3 + 0.5 * h * 0.05), rtol=1e-5
    )
    np.testing.assert_allclose(finding.numbers["coulomb_N"], 5.0, rtol=0.01)
    assert f"{finding.numbers['normal_N']:.3g} N" in finding.cause


def test_a_step_in_which_coulombs_law_settles_nothing_is_counted(monkeypatch):
    (finding,) = found(wiper(0.01))
    assert finding.numbers["steps_without_fixed_point"] == 0
    step = finding.numbers["step"]
    coulomb = LookedAt._coulomb
    monkeypatch.setattr(LookedAt, "_coulomb", lambda at: None if at.k == step else coulomb(at))
    (finding,) = found(wiper(0.01))
    assert finding.numbers["steps_without_fixed_point"] == 1
    assert finding.numbers["step"] != step


@pytest.mark.parametrize(("speed", "says"), [(4e-4, False), (0.05, True)])
def test_a_layer_of_less_than_a_tenth_of_the_force_is_not_said(speed, says):
    """mu_v h v over e: 0.8 %, and 100 %."""
    assert bool(found(wiper(0.01, speed))) is says


def plates(mu_top, h, steps):
    def plate(urdf, z, **more):
        return {"urdf": urdf, "pose": {"xyz": [0, 0, z]}, **more}

    def way(end, **more):
        return [{"t": 0.0, "s": 0.0, **more}, {"t": 0.5, "s": end, **more}]

    box = "<box size='0.4 0.2 {}'/>"
    bodies = {
        "belt": plate(slides("s", box.format(0.02)), -0.01, actuated=["s"], K_q={"s": 1e6},
                      targets=way(-0.005)),
        "press": plate(slides("zs", box.format(0.02), down=True), 0.05, actuated=["z", "s"],
                       K_q={"z": 1000, "s": 1e6}, targets=way(0.005, z=0.005)),
        "slab": {"urdf": block(0.5, (0.1, 0.1, 0.04)), "base": "floating",
                 "pose": {"xyz": [0, 0, 0.02]}},
    }  # fmt: skip
    tables = {"belt": ("belt/tip", "slab", 0.3, 4), "top": ("press/tip", "slab", mu_top, 4)}
    return run_of(bodies, tables, h=h, steps=steps, floor=None)


def test_a_slab_between_two_plates_goes_with_the_wrong_one():
    """It goes with the belt, by -5 mm, if mu_top 5 N < mu_belt (5 + 4.905) N."""
    run = plates(0.58, 0.1, 5)
    assert run["q"][-1][3] > 4e-3
    (finding,) = found(run)
    assert finding.name == "boundary layer"
    sticks, slips = sorted([finding.numbers["coulomb_mm"], finding.numbers["slip_mm"]])
    assert sticks < 1e-6 < 1.9 < slips


def test_a_slab_that_drag_keeps_from_going_with_its_belt():
    run = plates(0.55, 0.01, 50)
    assert -2.2e-3 < run["q"][-1][3] < -1.8e-3
    (finding,) = found(run)
    assert (finding.name, "it slips by 0.05" in finding.cause) == ("drag", True)


TIP = "<sphere radius='0.01'/>"


def lifted(mu_omega, speed=0.2 / 3, load=0.0):
    """A bar of 0.35 kg that two fingers lift 13.9 mm from its centre, with 10 N each.

    W (1 / mu_v + e / mu_omega) <= 2 N holds for mu_omega from 3.04 mm on; with W + m v / h in the
    place of W, 34 % more, from 4.49 mm on. A `load` [N] pulls it down at the end.
    """
    links = '<link name="post"/><link name="hand"/>'
    joints = (
        '<joint name="lift" type="prismatic"><parent link="post"/><child link="hand"/>'
        '<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1000" velocity="1"/></joint>'
    )
    for name, sign in (("left", 1), ("right", -1)):
        links += f'<link name="{name}">{collision(TIP)}</link>'
        joints += (
            f'<joint name="{name}" type="prismatic"><parent link="hand"/><child link="{name}"/>'
            f'<origin xyz="0.0139 {0.05 * sign} 0"/><axis xyz="0 {-sign} 0"/>'
            '<limit lower="-1" upper="1" effort="1000" velocity="1"/></joint>'
        )
    inside = {"left": 2.5e-3, "right": 2.5e-3}
    bodies = {
        "gripper": {
            "urdf": f'<robot name="g">{links}{joints}</robot>',
            "actuated": "all",
            "K_q": {"lift": 3000, "left": 4000, "right": 4000},
            "targets": [{"t": 0.0, "lift": 0.0, **inside},
                        {"t": 0.4, "lift": 0.4 * speed, **inside}],
        },
        "bar": {"urdf": block(0.35, (0.1, 0.08, 0.02)), "base": "floating",
                "wrenches": [{"t": t, "force": [0, 0, f]}
                             for t, f in ((0.0, 0), (0.48, 0), (0.58, -load))]},
    }  # fmt: skip
    grip = {"mu_v": 0.8, "mu_omega": mu_omega, "rows": 6, "k": 1, "beta": "bar"}
    grip["alpha"] = ["gripper/left", "gripper/right"]
    scene = {"h": 0.02, "steps": 30, "bodies": bodies, "contacts": {"grip": grip}}
    return load_scenario(scene).run(progress=False)


@pytest.mark.parametrize(
    ("mu_omega", "speed", "names"),
    [
        (4.0e-3, 0.2 / 3, ["drag"]),
        (4.0e-3, 0.05 / 3, []),
        (3.2e-3, 0.005 / 3, []),
        (4.7e-3, 0.2 / 3, []),
        (2.2e-3, 0.005 / 3, ["not in equilibrium"]),
    ],
)
def test_a_grip_that_turns_by_its_drag_alone(mu_omega, speed, names):
    run = lifted(mu_omega, speed)
    assert [finding.name for finding in found(run)] == names
    assert bool(np.linalg.norm(run["q"][-1][-4:-1]) > 1e-3) is bool(names)
    if names == ["drag"]:
        (finding,) = found(run)
        assert finding.remedy == "move more slowly, or take a larger h"
        assert ", and not without it, in step" in finding.cause


def test_what_is_out_of_balance_in_one_step_is_compared_in_the_others():
    """At the end 1 N pulls out of the pyramid what its drag alone turned before."""
    assert {finding.name for finding in found(lifted(4.0e-3, load=1.0))} == {
        "corners of the cone",
        "drag",
    }


def loaded(urdf, z, force=(0, 0, 0), mu_v=0.5, **more):
    body = {"urdf": urdf, "base": "floating", "pose": {"xyz": [0, 0, z]},
            "wrenches": [{"t": 0.0, "force": list(force)}]}  # fmt: skip
    return run_of({"box": body}, {"floor": ("floor", "box", mu_v, 4)}, **more)


BOX = block(1.0, (0.1, 0.1, 0.1))
TALL = block(1.0, (0.1, 0.1, 0.3))


@pytest.mark.parametrize(("h", "steps"), [(0.5, 2), (0.01, 20)])
def test_a_box_that_slides_down_a_slope_lacks_a_force_at_every_h(h, steps):
    """M g (sin 25 - 0.2 cos 25) = 2.37 N."""
    run = loaded(BOX, 0.05, mu_v=0.2, h=h, steps=steps, gravity=[4.1459, 0, -8.8909])
    (finding,) = run.findings
    assert finding.name == "not in equilibrium"
    np.testing.assert_allclose(finding.numbers["missing_N"], 2.3677, rtol=1e-3)
    assert "2.4 N are missing" in finding.cause


def test_a_box_that_topples_is_not_in_equilibrium():
    """At first 3.4 N - 9.81 N 50 / 150 = 0.13 N are missing, and more while it tips."""
    run = loaded(TALL, 0.15, (3.4, 0, 0), mu_v=0.9, steps=1)
    (finding,) = run.findings
    np.testing.assert_allclose(finding.numbers["missing_N"], 0.13, rtol=0.01)
    assert loaded(TALL, 0.15, (3.2, 0, 0), mu_v=0.9, steps=1).findings == ()


def test_a_stack_beyond_its_overhang_is_not_in_equilibrium():
    """Two equal boxes, the upper one over the edge by 60 % of its width, and by 40 %."""
    for out, falls in ((0.06, True), (0.04, False)):
        bodies = {
            name: {"urdf": BOX, "base": "floating", "pose": {"xyz": [x, 0, z]}}
            for name, x, z in (("low", 0, 0.05), ("high", out, 0.15))
        }
        tables = {"floor": ("floor", "low", 0.5, 4), "stack": ("low", "high", 0.5, 8)}
        names = [finding.name for finding in found(run_of(bodies, tables, steps=3))]
        assert names == ["not in equilibrium"] * falls


def test_a_slide_in_the_ellipsoid_is_judged_in_it():
    """6 N towards 45 degrees, of which friction takes 0.5 m g in every direction of the circle."""
    run = loaded(BOX, 0.05, (6 / np.sqrt(2), 6 / np.sqrt(2), 0), cone="ellipsoid", steps=20)
    (finding,) = run.findings
    np.testing.assert_allclose(finding.numbers["missing_N"], 6 - 0.5 * 9.81, rtol=0.01)


def pile(mu_v, cone, turned=0.3):
    """A ball on three balls that touch each other; by hand it stands from mu_v = 0.318 on."""
    r = 0.05
    out = 2 * r / np.sqrt(3)
    places = [[out * np.cos(a), out * np.sin(a), r] for a in turned + np.arange(3) * 2 * np.pi / 3]
    places.append([0, 0, r + np.sqrt(4 * r**2 - out**2)])
    bodies = {
        name: {"urdf": ball(1.0, r), "base": "floating", "pose": {"xyz": place}}
        for name, place in zip(("one", "two", "three", "top"), places, strict=True)
    }
    low = ["one", "two", "three"]
    tables = {"floor": ("floor", low, mu_v, 1), "on": (low, "top", mu_v, 1)}
    return run_of(bodies, tables, steps=5, cone=cone)


def test_a_pile_that_collapses_in_the_corners_of_the_pyramid():
    (finding,) = found(pile(0.36, "pyramid"))
    assert (finding.name, finding.remedy) == ("corners of the cone", 'set cone = "ellipsoid"')
    assert found(pile(0.36, "ellipsoid")) == found(pile(0.45, "pyramid")) == []
    for cone in ("pyramid", "ellipsoid"):
        assert {finding.name for finding in found(pile(0.3, cone))} == {"not in equilibrium"}
