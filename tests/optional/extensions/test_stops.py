"""Stops at joint limits: where a joint ends, and with which force, against closed forms."""

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import Extension, InputError
from quasistatic_ref.optional.extensions.stops import stops_of, urdf_limits
from tests.closeness import assert_relative, assert_within
from tests.files.urdf.urdf_texts import joint, link, mimic, robot
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


def scene(urdf, joint_limits="urdf", fast=True, **fields):
    body = {"urdf": urdf, **fields}
    if joint_limits is not None:
        body["joint_limits"] = joint_limits
    tables = {"h": H, "steps": 3, "gravity": [0, 0, 0], "bodies": {"c": body}}
    return qr.load_scenario(tables, fast=fast)


def actuated(*targets):
    """Fields of a drawer on a spring of 100 N/m with targets at 0, 0.01 s and so on."""
    table = [{"t": H * k, "slide": target} for k, target in enumerate(targets)]
    return {"actuated": ["slide"], "K_q": {"slide": 100.0}, "targets": table}


def pushed_drawer(scenario, force, steps, extension=None):
    """A run under a constant generalised force on the joint [N]."""
    simulator = scenario.simulator(extension)
    q = scenario.system.q_start
    return qr.rollout(simulator, q, [], steps, force=np.array([force]))


@pytest.mark.parametrize("fast", [False, True])
@pytest.mark.parametrize("force", [15.0, -25.0])
def test_a_drawer_that_is_pushed_stops_at_its_limits(force, fast):
    """Free, each step moves it by h^2 F / m; the stop bears F - m (limit - q) / h^2 of F."""
    lower, upper = -0.001, 0.002
    run = pushed_drawer(scene(drawer(), fast=fast), force, 10)
    assert set(run["certificate"].tolist()) == {"exact"}
    assert run.header.extra == ("c/slide at its lower limit", "c/slide at its upper limit")
    q = 0.0
    for k in range(10):
        end = float(np.clip(q + H**2 * force / M, lower, upper))
        np.testing.assert_allclose(run["q"][k + 1], [end], rtol=ROUNDING, atol=1e-18)
        stop = force - M * (end - q) / H**2
        expected = [max(-stop, 0.0), max(stop, 0.0)]
        assert_within(run["lam_extra"][k] / H, expected, ROUNDING * abs(force))
        q = end
    assert q == (upper if force > 0 else lower)  # all of these forces reach it


FREE_WAY = 4 * H**2 * 50.0 / M
"""Of a drawer under 50 N for four steps [m]."""


@pytest.mark.parametrize(
    ("ends", "force", "end", "stops"),
    [
        ([-0.001, 0.0015], 50.0, 0.0015, 2),
        ([0, 0], 50.0, 0.0, 2),
        ([-np.inf, 0.0015], 50.0, 0.0015, 1),
        ([-0.0015, np.inf], -50.0, -0.0015, 1),
        ([-np.inf, 0.0015], -50.0, -FREE_WAY, 1),
        ([-0.0015, np.inf], 50.0, FREE_WAY, 1),
        ([-np.inf, np.inf], 50.0, FREE_WAY, 0),
    ],
)
def test_a_table_by_joint_takes_the_place_of_the_file(ends, force, end, stops):
    """The drawer may go to 2 mm by its file; what has no bound has no row, and goes on."""
    run = pushed_drawer(scene(drawer(), {"slide": ends}), force, 4)
    assert len(run.header.extra) == stops
    if abs(end) < FREE_WAY:
        assert run["q"][-1, 0] == end
        assert not [one for one in run.findings if "limit" in one.name]
    assert_relative(run["q"][-1, 0], end)


@pytest.mark.parametrize(("table", "words"), [
    ({"slid": [0, 1]}, r"bodies.c.joint_limits.slid: is unknown; did you mean 'slide'"),
    ({"slide": [1, 0]}, r"joint_limits.slide: must be a least position .* then a greatest"),
    ({"slide": [np.inf, np.inf]}, r"joint_limits.slide: must be a least position \(or -inf\)"),
    ({"slide": [-np.inf, -np.inf]}, r"and then a greatest one \(or inf\) .*got \[-inf, -inf\]"),
    ({"slide": [np.nan, 1]}, r"joint_limits.slide: must contain finite numbers only"),
    ({"slide": 1}, r"joint_limits.slide: must be 2 numbers"),
    ("file", r"bodies.c.joint_limits: must be a table of named fields"),
])  # fmt: skip
def test_a_table_of_limits_that_means_nothing_is_refused(table, words):
    with pytest.raises(InputError, match=words):
        scene(drawer(), table)


@pytest.mark.parametrize(("lower", "upper", "beyond", "found"), [
    (0, 0.5, 9e-5, False), (0, 0.5, 1.1e-4, True),
    (0, 0.02, 1.9e-5, False), (0, 0.02, 2.1e-5, True), (0, 0, 1e-5, True),
])  # fmt: skip
def test_a_joint_may_be_beyond_its_limit_by_little(lower, upper, beyond, found):
    """By a thousandth of its way, and 0.1 mm at most; so may its target."""
    text = drawer(lower, upper)
    moved = pushed_drawer(scene(text, None), -beyond * M / H**2, 1)
    aimed = scene(text, None, **actuated(-beyond)).run()
    for run, name in ((moved, "joint-beyond-a-limit"), (aimed, "target-beyond-a-limit")):
        assert any(one.name == name for one in run.findings) == found


def test_a_target_beyond_a_limit_by_little_is_said_with_the_digits_that_differ():
    run = scene(drawer(0, 0.5), None, **actuated(0.5002)).run()
    assert "0.5002 m at step 0, beyond its limit, 0.5 m" in str(run.findings)


@pytest.mark.parametrize("start", [0.0, 0.005])
def test_an_actuated_joint_presses_against_its_stop(start):
    """Its spring of 100 N/m towards 5 mm bears 100 N/m (5 mm - 2 mm) = 0.3 N on the stop.

    A target that does not move has no way of which the error could be a share.
    """
    run = scene(drawer(), **actuated(start, 0.005)).run()
    assert_relative(run["q"][1:, 0], 0.002)
    assert_relative(run["lam_extra"][:, 1] / H, 0.3)
    assert not [one for one in run.findings if "limit" in one.name]


@pytest.mark.parametrize(("multiplier", "offset"), [(-2.0, 0.0), (0.5, -0.0002)])
def test_a_joint_that_follows_limits_its_leader(multiplier, offset):
    """Both lie within -1 mm and 2 mm: q, and multiplier q + offset."""
    follower = joint_with_limits(-0.001, 0.002, mimic("slide", multiplier, offset), "under")
    text = drawer(-0.001, 0.002, link("lower"), follower.replace('"drawer"', '"lower"'))
    system = scene(text).system
    found = stops_of(system, urdf_limits(system, ["c"]))
    ends = sorted((end - offset) / multiplier for end in (-0.001, 0.002))
    assert found.names == ("c/slide",)
    expected = max(ends[0], -0.001), min(ends[1], 0.002)
    assert_relative((found.lower[0], found.upper[0]), expected)


SLOW = drawer().replace("</robot>", link("e") + joint("f", "cabinet", "e", "prismatic",
                        more=mimic("slide", 0, 5)) + "</robot>")  # fmt: skip
REFUSED = {
    "no position": (
        drawer(-0.001, 0.002, link("lower"),
               joint_with_limits(0.005, 0.006, mimic("slide"), "under").replace("drawer", "lower")),
        "c/slide: has no position within its limits and those of the joints that mimic it",
    ),
    "wrong order": (
        drawer(0.002, -0.001), "c/slide: its lower limit is above its upper one, -0.001",
    ),
    "a follower that stands still": (SLOW, "c/f: stands still beyond its limits, -1 to 1"),
    "a start beyond one": (
        drawer(0.001),
        "c/slide: starts beyond its limits, 0.001 to 0.002; change the start, or leave out",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("urdf", "words"), REFUSED.values(), ids=REFUSED)
def test_limits_that_cannot_stop_a_joint_are_refused_by_its_name(urdf, words):
    with pytest.raises(InputError, match=words):
        scene(urdf)
    scene(urdf, joint_limits=None)


def test_a_follower_that_stands_still_within_its_limits_and_a_wheel_limit_nothing():
    wheel = link("rim") + joint("wheel", "cabinet", "rim", "continuous", "1 0 0")
    inside = SLOW.replace('offset="5"', 'offset="0.5"').replace("</robot>", wheel + "</robot>")
    assert [*urdf_limits(scene(inside).system, ["c"])] == ["c/slide"]


BOUNDS = {
    "both": ('lower="-0.001" upper="0.002" ', (-0.001, 0.002), ""),
    "zeros": ('lower="0" upper="0" ', (0.0, 0.0), "both bounds are 0, which hold the joint there"),
    "none": ("", None, "has no bounds, and limits no position"),
    "upper": ('upper="0.002" ', (0.0, 0.002), "has no lower bound, which is 0 then"),
    "lower": ('lower="-0.001" ', (-0.001, 0.0), "has no upper bound, which is 0 then"),
}


@pytest.mark.parametrize(("written", "expected", "note"), BOUNDS.values(), ids=BOUNDS)
def test_bounds_that_are_missing_and_bounds_of_zero(written, expected, note):
    text = drawer().replace('lower="-0.001" upper="0.002" ', written)
    system = scene(text).system
    assert [*urdf_limits(system, ["c"]).values()] == ([expected] if expected else [])
    notes = [f"c: joint[slide].limit: {note}"] if note else []
    assert [each for each in system.notes if "limit" in each] == notes
    assert system.joints[0].limits == expected


def test_a_users_extension_stands_beside_the_stops():
    """A plane of the user's at 1.5 mm is met before the stop at 2 mm, where 50 N as a cost end."""
    scenario = scene(drawer())

    def plane(q):
        return Extension(lambda s: [s.delta_q[0] <= 0.0015 - q[0]])

    run = pushed_drawer(scenario, 50.0, 2, plane)
    assert_relative(run["q"][1:, 0], 0.0015)
    push = Extension(lambda s: [-H * 50.0 * s.delta_q[0]])  # 50 N as a cost
    run = pushed_drawer(scenario, 0.0, 2, lambda q: push)
    assert set(run["certificate"].tolist()) == {"exact"}
    assert run["q"][-1, 0] == 0.002
