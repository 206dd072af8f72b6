"""What an artifact changes is said with both numbers; where nothing changes, nothing is."""

import re

import numpy as np
import pytest

from quasistatic_ref import Sphere, load_scenario
from quasistatic_ref.lab.grasp import grasp_report
from tests.files.urdf.urdf_texts import link, robot
from tests.optional.doctor.words import (
    block,
    driven,
    fingers,
    free,
    joint,
    scene,
    slides,
    solid,
)

ARTIFACTS = {"artifact", "corners", "equilibrium"}


def run_of(*parts, **more):
    return scene(*parts, **more).run(progress=False)


def found(run):
    return [finding for finding in run.findings if finding.name in ARTIFACTS]


def plates(mu_top, h, steps):
    """A slab on a belt, under a plate that goes the other way and is pressed down with 5 N."""
    box = "<box size='0.4 0.2 0.02'/>"
    back = [{"t": 0.0, "s": 0.0}, {"t": 0.5, "s": -0.005}]
    forth = [{"t": 0.0, "s": 0.0, "z": 0.005}, {"t": 0.5, "s": 0.005, "z": 0.005}]
    press = slides("zs", box, down=True)
    bodies = {
        "belt": driven(slides("s", box), (0, 0, -0.01), {"s": 1e6}, back),
        "press": driven(press, (0, 0, 0.05), {"z": 1000, "s": 1e6}, forth),
        "slab": free(block(0.5, (0.1, 0.1, 0.04)), (0, 0, 0.02)),
    }
    tables = {"belt": ("belt/tip", "slab", 0.3, 4), "top": ("press/tip", "slab", mu_top, 4)}
    return run_of(bodies, tables, steps, h=h)


def test_a_slab_between_two_plates_goes_with_the_wrong_one():
    """It goes with the belt, by -5 mm, if mu_top 5 N < mu_belt (5 + 4.905) N."""
    run = plates(0.58, 0.1, 5)
    assert run["q"][-1][3] > 4e-3
    (finding,) = found(run)
    assert 'set law = "coulomb"' in finding.remedy
    assert finding.numbers["slowly_m"] < 1e-9 < 1.9e-3 < finding.numbers["run_m"]
    assert "slips by 9.99 mm in the run" in finding.cause


def test_a_slab_that_drag_keeps_from_going_with_its_belt():
    run = plates(0.55, 0.01, 50)
    assert -2.2e-3 < run["q"][-1][3] < -1.8e-3
    (finding,) = found(run)
    assert "because of drag: slowly it sticks" in finding.cause


def lifted(mu_omega, speed=0.2 / 3, load=0.0):
    """A bar of 0.35 kg that two fingers lift 13.9 mm from its centre, with 10 N each.

    W (1 / mu_v + e / mu_omega) <= 2 N holds for mu_omega from 3.04 mm on; with W + m v / h in the
    place of W, 34 % more, from 4.49 mm on. A `load` [N] pulls it down at the end.
    """
    frame = [link("post", inertial=""), link("hand", inertial="")]
    hand = robot(*frame, joint("lift", "post", "hand", "0 0 1"), *fingers("hand", 0.0139, 0.05))
    pressed = {"left": 2.5e-3, "right": 2.5e-3}
    way = [{"t": 0.0, "lift": 0.0, **pressed}, {"t": 0.4, "lift": 0.4 * speed, **pressed}]
    bar = free(block(0.35, (0.1, 0.08, 0.02)), (0, 0, 0))
    for t, f in ((0.48, 0), (0.58, -load)):
        bar["wrenches"].append({"t": t, "force": [0, 0, f]})
    bodies = {
        "gripper": driven(hand, (0, 0, 0), {"lift": 3000, "left": 4000, "right": 4000}, way),
        "bar": bar,
    }
    grip = {"grip": (["gripper/left", "gripper/right"], "bar", 0.8, 1, mu_omega)}
    return run_of(bodies, grip, 30, h=0.02)


@pytest.mark.parametrize(
    ("mu_omega", "speed", "names"),
    [
        (4.0e-3, 0.2 / 3, ["artifact"]),
        (4.0e-3, 0.05 / 3, []),
        (3.2e-3, 0.005 / 3, []),
        (4.7e-3, 0.2 / 3, []),
        (2.2e-3, 0.005 / 3, ["equilibrium", "corners"]),
    ],
)
def test_a_grip_that_turns_by_its_drag_alone(mu_omega, speed, names):
    run = lifted(mu_omega, speed)
    assert [finding.name for finding in found(run)] == names
    assert bool(np.linalg.norm(run["q"][-1][-4:-1]) > 1e-3) is bool(names)
    if names == ["artifact"]:
        (finding,) = found(run)
        assert finding.remedy == "move more slowly, or take a larger h"
        assert "because of drag: slowly it sticks" in finding.cause


def test_what_is_out_of_balance_in_one_step_is_compared_in_the_others():
    """At the end 1 N pulls out of the pyramid what its drag alone turned before."""
    assert {finding.name for finding in found(lifted(4.0e-3, load=1.0))} == {
        "corners",
        "artifact",
    }


def pile(mu_v, cone):
    """A ball on three balls that touch each other; by hand it stands from mu_v = 0.318 on."""
    r = 0.05
    out = 2 * r / np.sqrt(3)
    ball = solid(1.0, Sphere(r))
    low = ["one", "two", "three"]
    bodies = {
        name: free(ball, (out * np.cos(angle), out * np.sin(angle), r))
        for name, angle in zip(low, 0.3 + np.arange(3) * 2 * np.pi / 3, strict=True)
    }
    bodies["top"] = free(ball, (0, 0, r + np.sqrt(4 * r**2 - out**2)))
    tables = {"floor": ("floor", low, mu_v, 1), "on": (low, "top", mu_v, 1)}
    return run_of(bodies, tables, 5, cone=cone)


def test_a_pile_that_collapses_in_the_corners_of_the_pyramid():
    (finding,) = found(pile(0.36, "pyramid"))
    assert (finding.name, finding.remedy) == ("corners", 'set cone = "ellipsoid"')
    assert found(pile(0.36, "ellipsoid")) == found(pile(0.45, "pyramid")) == []
    for cone in ("pyramid", "ellipsoid"):
        names = {finding.name for finding in found(pile(0.3, cone))}
        assert names - {"corners"} == {"equilibrium"}


@pytest.mark.parametrize(
    ("mu_omega", "h"),
    [(1.7e-3, 0.01), pytest.param(2e-3, 0.005, marks=pytest.mark.long), (2.05e-3, 0.005)],
)
def test_a_turn_by_drag_is_that_of_the_whole_run(mu_omega, h):
    """Of the bunny, by some degrees; before it settles by a tenth of one as its grip closes."""
    changes = {"contacts.grip.mu_omega": mu_omega, "h": h, "steps": round(3 / h)}
    scenario = load_scenario("bunny_grasp", changes, fast=True)
    run = scenario.run(progress=False)
    (turns,) = run.findings
    way = float(re.search(r"turns by ([\d.]+) deg in the run, because of drag", turns.cause)[1])
    assert way == pytest.approx(grasp_report(scenario, run)["rotation_deg"], abs=0.12)
    assert run.header.not_looked_at == ""
