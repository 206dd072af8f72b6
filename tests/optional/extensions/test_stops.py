"""Stops at joint limits: where a joint ends, and with which force, against closed forms."""

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.errors import InputError
from quasistatic_ref.optional.extensions.stops import urdf_limits
from quasistatic_ref.step.extension import Extension
from tests.closeness import assert_relative, assert_within
from tests.model.urdf.urdf_texts import joint, link, mimic, robot
from tests.tolerances import ROUNDING

H = 0.01
M = 2.0
"""Of a link of these texts [kg]."""


def joint_with_limits(lower, upper, more="", name="slide"):
    text = joint(name, "cabinet", "drawer", "prismatic", "1 0 0", more)
    return text.replace('lower="-1" upper="1"', f'lower="{lower}" upper="{upper}"')


def drawer(lower=-0.001, upper=0.002, *more):
    return robot(
        link("cabinet", inertial=""), link("drawer"), joint_with_limits(lower, upper), *more
    )


def scene(urdf, joint_limits="urdf", **fields):
    body = {"urdf": urdf, **fields}
    if joint_limits is not None:
        body["joint_limits"] = joint_limits
    return {"h": H, "steps": 3, "gravity": [0, 0, 0], "bodies": {"c": body}}


def pushed_drawer(scenario, force, steps, extension=None):
    """A run under a constant generalised force on the joint [N]."""
    simulator = scenario.simulator(extension)
    q = scenario.system.q_start
    return qr.rollout(simulator, q, [], steps, force=np.array([force]), progress=False)


@pytest.mark.parametrize("fast", [False, True])
@pytest.mark.parametrize("force", [5.0, 15.0, 40.0, -5.0, -25.0])
def test_a_drawer_that_is_pushed_stops_at_its_limits(force, fast):
    """Free, each step moves it by h^2 F / m; the stop bears F - m (limit - q) / h^2 of F."""
    lower, upper = -0.001, 0.002
    run = pushed_drawer(qr.load_scenario(scene(drawer()), fast=fast), force, 10)
    assert set(run["certificate"].tolist()) == {"exact"}
    assert run.header["extra"] == ["c/slide at its lower limit", "c/slide at its upper limit"]
    q = 0.0
    for k in range(10):
        end = float(np.clip(q + H**2 * force / M, lower, upper))
        np.testing.assert_allclose(run["q"][k + 1], [end], rtol=ROUNDING, atol=1e-18)
        stop = force - M * (end - q) / H**2
        expected = [max(-stop, 0.0), max(stop, 0.0)]
        assert_within(run["lam_extra"][k] / H, expected, ROUNDING * abs(force))
        q = end
    assert q == (upper if force > 0 else lower)  # all of these forces reach it


def test_the_account_of_a_run_has_the_force_of_a_stop():
    """20 N move 2 kg by 1 mm a step: the second ends at 2 mm, from the third on the stop has them.

    In the second it has 20 N - 2 kg 1 mm / h^2 = 0, up to rounding.
    """
    run = pushed_drawer(qr.load_scenario(scene(drawer())), 20.0, 10)
    (stop,) = run.account().stops
    assert stop.name == "c/slide at its upper limit"
    assert_relative(stop.force[2:], 20.0, ROUNDING)
    assert_relative(run.account().numbers["stops"][stop.name]["largest_force"], 20.0, ROUNDING)


def test_an_actuated_joint_presses_against_its_stop():
    """Its spring of 100 N/m towards 5 mm bears 100 N/m (5 mm - 2 mm) = 0.3 N on the stop."""
    target = [{"t": 0, "slide": 0.0}, {"t": 0.01, "slide": 0.005}]
    fields = {"actuated": ["slide"], "K_q": {"slide": 100.0}, "targets": target}
    run = qr.load_scenario(scene(drawer(), **fields)).run(progress=False)
    assert_relative(run["q"][1:, 0], 0.002, ROUNDING)
    assert_relative(run["lam_extra"][:, 1] / H, 0.3, ROUNDING)
    assert not [one for one in run.findings if "limit" in one.name]


def test_a_joint_that_holds_its_place_against_a_load_is_no_error():
    """A target that does not move has no way of which the error could be a share."""
    fields = {"actuated": ["slide"], "K_q": {"slide": 100.0}, "targets": [{"t": 0, "slide": 0.005}]}
    run = qr.load_scenario(scene(drawer(), **fields)).run(progress=False)
    assert run["q"][-1, 0] == pytest.approx(0.002, rel=ROUNDING)


def test_a_door_that_a_contact_pushes_stops():
    """The door of models/ with limits of +-0.05 rad ends there; else it goes on to 0.08 rad."""
    free = qr.load_scenario("door", steps=80)
    text = free.system.texts[[b.name for b in free.system.bodies].index("door")]
    assert 'lower="-3" upper="3"' in text.replace("3.0", "3")
    narrow = text.replace('"-3', '"-0.05').replace('"3', '"0.05')
    settings = {"bodies.door.urdf": narrow}
    beyond = qr.load_scenario("door", settings, steps=80).run(progress=False)
    assert [one.name for one in beyond.findings if one.grave] == ["joint beyond a limit"]
    limited_by = {**settings, "bodies.door.joint_limits": "urdf"}
    runs = [
        qr.load_scenario("door", limited_by, steps=80, fast=fast).run(progress=False)
        for fast in (False, True)
    ]
    hinge = runs[0].header["extra"].index("door/hinge at its upper limit")
    place = free.system.named.q("door/hinge")[0]
    for run in runs:
        assert set(run["certificate"].tolist()) == {"exact"}
        assert run["q"][-1, place] == pytest.approx(0.05, rel=ROUNDING)
        assert run["lam_extra"][-1, hinge] > 0
    assert runs[0]["q"].tolist() == runs[1]["q"].tolist()
    assert beyond["q"][-1, place] > 0.07


@pytest.mark.parametrize(("multiplier", "offset"), [(-2.0, 0.0), (3.0, 0.001), (0.5, -0.0002)])
def test_a_joint_that_follows_limits_its_leader(multiplier, offset):
    """Both lie within -1 mm and 2 mm: q, and multiplier q + offset."""
    follower = joint_with_limits(-0.001, 0.002, mimic("slide", multiplier, offset), "under")
    text = drawer(-0.001, 0.002, link("lower"), follower.replace('"drawer"', '"lower"'))
    system = qr.load_scenario(scene(text)).system
    found = urdf_limits(system, ["c"])
    ends = sorted((end - offset) / multiplier for end in (-0.001, 0.002))
    assert found.names == ("c/slide",)
    expected = max(ends[0], -0.001), min(ends[1], 0.002)
    assert_relative((found.lower[0], found.upper[0]), expected, ROUNDING)


def test_limits_that_leave_no_position_are_refused():
    follower = joint_with_limits(0.005, 0.006, mimic("slide"), "under").replace(
        '"drawer"', '"lower"'
    )
    with pytest.raises(InputError, match="has no position within its limits and those of the"):
        qr.load_scenario(scene(drawer(-0.001, 0.002, link("lower"), follower)))


def test_limits_in_the_wrong_order_are_refused_where_they_stop_and_otherwise_none():
    tables = scene(drawer(0.002, -0.001))
    with pytest.raises(
        InputError, match=r"c/slide: its lower limit is above its upper one, -0.001"
    ):
        qr.load_scenario(tables)
    del tables["bodies"]["c"]["joint_limits"]
    assert qr.load_scenario(tables).system.joints[0].limits is None


def test_a_start_beyond_a_limit_is_refused_by_joint():
    problem = r"c/slide.*starts beyond its limits, -0.001 to 0.002; change the start, or leave out"
    with pytest.raises(InputError, match=problem):
        qr.load_scenario(scene(drawer(), positions={"slide": 0.0021}))
    qr.load_scenario(scene(drawer(), positions={"slide": 0.002}))  # at the limit


BOUNDS = {
    "both": ('lower="-0.001" upper="0.002" ', (-0.001, 0.002), ""),
    "zeros": ('lower="0" upper="0" ', (0.0, 0.0), "both bounds are 0, which hold the joint there"),
    "none": ("", None, "has no bounds, and limits no position"),
    "upper": ('upper="0.002" ', (0.0, 0.002), "has no lower bound, which is 0 then"),
    "lower": ('lower="-0.001" ', (-0.001, 0.0), "has no upper bound, which is 0 then"),
    "wide": ('lower="-1e16" upper="1e16" ', (-1e16, 1e16), ""),
}


@pytest.mark.parametrize(("written", "expected", "note"), BOUNDS.values(), ids=BOUNDS)
def test_bounds_that_are_missing_and_bounds_of_zero(written, expected, note):
    text = drawer().replace('lower="-0.001" upper="0.002" ', written)
    system = qr.load_scenario(scene(text)).system
    limits = urdf_limits(system, ["c"])
    assert [*zip(limits.lower, limits.upper, strict=True)] == ([expected] if expected else [])
    notes = [f"c: joint[slide].limit: {note}"] if note else []
    assert [each for each in system.notes if "limit" in each] == notes
    assert system.joints[0].limits == expected


def test_a_joint_that_is_held_by_zeros_bears_its_force():
    run = pushed_drawer(qr.load_scenario(scene(drawer(0, 0))), 4.0, 3)
    assert abs(run["q"]).max() == 0.0


def test_a_follower_that_stands_still_beyond_its_limits_is_refused():
    text = drawer().replace("</robot>", "") + (
        link("e") + joint("f", "cabinet", "e", "prismatic", more=mimic("slide", 0, 5))
    )
    with pytest.raises(InputError, match=r"c/f: stands still beyond its limits, -1 to 1"):
        qr.load_scenario(scene(text + "</robot>"))
    inside = text.replace('offset="5"', 'offset="0.5"') + "</robot>"
    assert urdf_limits(qr.load_scenario(scene(inside)).system, ["c"]).names == ("c/slide",)


def test_without_the_option_a_joint_beyond_its_limit_is_a_finding():
    """4 N move 2 kg by 0.2 mm a step: 15 steps end at 3 mm."""
    run = pushed_drawer(qr.load_scenario(scene(drawer(), joint_limits=None)), 4.0, 15)
    assert "lam_extra" not in run.arrays
    (found,) = (one for one in run.findings if one.name == "joint beyond a limit")
    assert found.grave
    assert found.numbers["position_m"] == pytest.approx(0.003, rel=1e-9)
    assert found.numbers["limit_m"] == 0.002
    assert 'bodies.c.joint_limits = "urdf"' in found.remedy


def test_a_users_extension_stands_beside_the_stops():
    """A plane of the user's at 1.5 mm is met before the stop at 2 mm, where 50 N as a cost end."""
    scenario = qr.load_scenario(scene(drawer()))

    def plane(q):
        return Extension(lambda s: [s.delta_q[0] <= 0.0015 - q[0]])

    run = pushed_drawer(scenario, 50.0, 2, plane)
    assert_relative(run["q"][1:, 0], 0.0015, ROUNDING)

    def pull(q):
        return Extension(lambda s: [-H * 50.0 * s.delta_q[0]])  # 50 N as a cost

    run = pushed_drawer(scenario, 0.0, 2, pull)
    assert set(run["certificate"].tolist()) == {"exact"}
    assert run["q"][-1, 0] == 0.002


def test_a_written_scenario_keeps_its_stops(tmp_path):
    scenario = qr.load_scenario(scene(drawer()))
    path = qr.scenario_written(scenario, tmp_path / "scene.toml")
    again = qr.load_scenario(path)
    runs = [pushed_drawer(one, 40.0, 3) for one in (scenario, again)]
    assert runs[0]["q"].tolist() == runs[1]["q"].tolist()
    assert runs[1]["q"][-1, 0] == pytest.approx(0.002, rel=ROUNDING)
