"""Scenario files that cannot be used, each a distinct cause: file, field and value are named."""

import math
from datetime import date

import pytest

from quasistatic_ref import InputError, QuasistaticError, load_scenario
from tests.errors.scene import SCENE, changed, dotted, numeric_fields, scene_written
from tests.files.urdf.urdf_texts import collision, link, robot

BALL = "bodies/ball/"
RAIL = "bodies/rail/"
CAUSES = {
    # name: (changes to the scene, the field named, words of the sentence)
    "very many steps": (("steps", 10**8), "steps", "must be at most 10000000 (got 100000000)"),
    "very many bodies": (
        ("bodies", {f"b{i}": {} for i in range(1001)}),
        "bodies",
        "are more than 1000; whole arrays",
    ),
    "a name of several lines": (("solver/a\nb\u001b", 1), "solver.a\\nb\\x1b", "is unknown"),
    "h by another name": (
        ("h", ...), ("dt", 0.01), "dt", "is unknown; did you mean 'h'? known: bodies",
    ),
    "friction at the top": (
        ("mu_v", 0.5), "mu_v",
        "is unknown; did you mean 'mu_v' of [contacts.NAME], as a setting \"contacts.floor.mu_v\"? "
        "known: bodies",
    ),
    "a contact's field without its table": (
        ("push", {"mu_v": 0.5}), "push", "is unknown; did you mean 'contacts.push'?",
    ),
    "stiffness of a misspelt joint": (
        (RAIL + "K_q", {"slid": 5}), "bodies.rail.K_q.slid", "did you mean 'slide'? known: slide",
    ),
    "a waypoint without its time": (
        (RAIL + "targets/0", {"time": 0.0, "slide": 0.0}),
        "bodies.rail.targets[0].time", "did you mean 't'? known: slide, t",
    ),
    "no backend, no certificate": (
        ("solver", {"backend": "none", "certify": "off"}),
        "solver.backend", "has no answer of its own; use certify = 'full' (got 'none')",
    ),
    "no depth at all": (("limits/penetration", 0), "limits.penetration", "greater than 0 (got 0)"),
    "a body out of the scene": (
        (BALL + "pose/xyz/0", 200.0), "bodies", "at the start, link ball/ball is 200 m",
    ),
    "a shape out of this world": (
        ("shapes/wall/pose/xyz/0", 1e154), "shapes.wall.pose.xyz", "must be at most 1e+15 (got 1e",
    ),
    "nothing that moves": (
        ("bodies/rail", ...), ("bodies/ball", {"urdf": "ball.urdf"}), ("contacts", {}),
        "bodies", "no body can move",
    ),
    "a blank URDF": ((BALL + "urdf", " "), "bodies.ball.urdf", "must name a file (got ' ')"),
    "a URDF that is not there": (
        (BALL + "urdf", "boll.urdf"), "bodies.ball.urdf",
        "names no file; a path begins at the scenario's folder (got 'boll.urdf')",
    ),
    "a cloud that is not there": ((BALL + "cloud", "c.npy"), "bodies.ball.cloud", "names no file"),
    "actuated a number": ((RAIL + "actuated", 1), "bodies.rail.actuated", "a list of joint names"),
    "a joint with no stiffness": ((RAIL + "K_q", ...), "bodies.rail.K_q", "is missing for slide"),
    "stiffness not definite": (
        (RAIL + "K_q", [[-5.0]]), "bodies.rail.K_q", "must be positive definite",
    ),
    "stiffness not symmetric": (
        (BALL + "actuated", "all"), (BALL + "wrenches", ...),
        (BALL + "K_q", [[float(i == j) + 0.1 * (i > j) for j in range(6)] for i in range(6)]),
        "bodies.ball.K_q", "must be symmetric",
    ),
    "stiffness where nothing is actuated": (
        (BALL + "K_q", {"base": 5}), "bodies.ball.K_q.base", "is unknown; known: none (got 5)",
    ),
    "gravity for nobody": (
        (BALL + "gravity_compensated", False), "bodies.ball.gravity_compensated",
        "needs an actuated joint, and this body has none",
    ),
    "a target for what is free": (
        (BALL + "targets", [{"t": 0, "base": {}}]),
        "bodies.ball.targets[0].base", "is not an actuated joint of this body; known: none",
    ),
    "a waypoint of nothing": (
        (RAIL + "targets/0/slide", ...), "bodies.rail.targets[0]",
        "sets no joint; give the position of at least one (got {'t'",
    ),
    "waypoints that stand still": ((RAIL + "targets/1/t", 0.0), "rail/slide", "must increase"),
    "a wrench on what is fixed": (
        (RAIL + "wrenches", [{"t": 0, "force": [1, 0, 0]}]),
        "bodies.rail.wrenches", 'have no effect on a body with base = "fixed"; remove them',
    ),
    "a wrench of nothing": (
        (BALL + "wrenches", [{"t": 0}]), "bodies.ball.wrenches[0]", "must contain a force",
    ),
    "wrenches backwards": (
        (BALL + "wrenches", [{"t": 1, "force": [0] * 3}, {"t": 0, "force": [0] * 3}]),
        "bodies.ball.wrenches", "must have increasing times t (got [1.0, 0.0])",
    ),
    "two shapes in one": (
        ("shapes/wall/sphere", {"radius": 1}), "shapes.wall.shape", "must be exactly one of",
    ),
    "a normal of zero": (
        ("shapes/floor/halfspace/normal", [0, 0, 0]), "shapes.floor.halfspace", "must not be zero",
    ),
    "a shape named as a body": (
        ("shapes/ball", {"sphere": {"radius": 1}}), "shapes.ball", "is also the name of a body",
    ),
    "an unknown side": (("contacts/push/alpha", "rail/plat"), "push.alpha", "mean 'rail/plate'"),
    "a side without shapes": (
        ("contacts/push/alpha", "rail/rail"), "contacts.push.alpha", "has no collision shape",
    ),
    "no sides": (("contacts/push/alpha", []), "contacts.push.alpha", "at least one shape (got [])"),
    "a side against itself": (("contacts/push/alpha", "ball"), "contacts.push", "the same link"),
    "a side twice": (("contacts/push/alpha", ["rail/plate"] * 2), "contacts.push", "twice"),
    "two sides that stand still": (
        (RAIL + "urdf", "ball.urdf"), (RAIL + "actuated", []), (RAIL + "K_q", ...),
        (RAIL + "targets", ...), (RAIL + "positions", ...),
        ("contacts/push", {"alpha": "rail", "beta": "floor", "mu_v": 0.5, "rows": 4}),
        "contacts.push", "cannot move relative to each other, so it has no effect",
    ),
    "torsion without rows": (
        ("contacts/push/mu_omega", 0.01), "contacts.push.mu_omega", "has no effect with rows = 4",
    ),
    "a distance without a unit": (
        ("contacts/push/k", {"within": "5"}), "contacts.push.k.within", "in m, cm, mm, um, as",
    ),
    "a distance of no number": (
        ("contacts/push/k", {"within": "5e mm"}), "contacts.push.k.within", "finite decimal number",
    ),
}  # fmt: skip


def test_very_many_pairs_are_refused_before_they_are_made():
    balls = robot(link("a", 224 * collision('<sphere radius="1"/>')))
    bodies = {name: {"urdf": balls} for name in ("one", "two")}
    push = {"alpha": "one", "beta": "two", "mu_v": 0.0, "rows": 4}
    says = r"contacts.push: makes more pairs than 50000 .*; name fewer shapes \(got 50176\)"
    with pytest.raises(InputError, match=says):
        load_scenario({"h": 1, "steps": 1, "bodies": bodies, "contacts": {"push": push}})


@pytest.mark.parametrize("cause", CAUSES)
def test_a_scenario_that_cannot_be_used_is_refused(tmp_path, refused, cause):
    *changes, field, words = CAUSES[cause]
    path = scene_written(tmp_path, changed(SCENE, *changes))
    sentence = refused("run", path, "--out", tmp_path / "out")
    assert sentence.startswith(f"{path}: ")
    assert field in sentence.removeprefix(f"{path}: ").split(": ")[0]
    assert words in sentence


@pytest.fixture
def here(tmp_path, monkeypatch):
    """The working folder holds the files that the scene names."""
    scene_written(tmp_path)
    monkeypatch.chdir(tmp_path)


NO_NUMBERS = (math.nan, -math.inf, date(2020, 1, 1), 16**5000)
"""As TOML has them: also a date, and more digits than Python reads in decimal."""


@pytest.mark.parametrize("field", list(numeric_fields(SCENE)))
def test_values_that_are_no_number_are_refused_in_every_field(here, field):
    for number in NO_NUMBERS:
        with pytest.raises(InputError) as caught:
            load_scenario(changed(SCENE, (field, number)))
        sentence = str(caught.value)
        assert sentence.isprintable()
        assert sentence.startswith(dotted(SCENE, field))


PLAIN = changed(SCENE, ("bodies/rail/K_q", [[500.0]]))
ROUND = changed(
    PLAIN,
    ("shapes/egg", {"ellipsoid": {"size": [0.1, 0.2, 0.3]}, "pose": {"xyz": [0.0, -9.0, 0.0]}}),
    ("shapes/hat", {"cone": {"radius": 0.1, "length": 0.3}, "pose": {"xyz": [-9.0, 0.0, 0.0]}}),
    ("shapes/can", {"cylinder": {"radius": 0.1, "length": 0.3}, "pose": {"xyz": [-9.0, 9.0, 0.0]}}),
    ("shapes/pea", {"sphere": {"radius": 0.1}, "pose": {"xyz": [-9.0, -9.0, 0.0]}}),
    ("contacts/far", {"alpha": ["egg", "hat", "can", "pea", "wall", "post"], "beta": "ball",
                      "mu_v": 0.2, "mu_omega": 0.1}),
)  # fmt: skip
"""The same scene with a shape of every other kind in reach of the ball's contacts."""
AT_THE_ENDS = (5e-324, -1e-160, 1e15, -1.7e308)
"""A subnormal number, one whose square is 0, the largest that a scenario takes, the largest."""
OF_SHAPES = ("bodies/ball/pose", "shapes", "contacts/far")
"""Tables whose numbers change how far the ball is from a shape of any kind."""


@pytest.mark.parametrize("fast", [True, pytest.param(False, marks=pytest.mark.long)])
@pytest.mark.parametrize(("first", "field"), [*enumerate(numeric_fields(ROUND))])
def test_numbers_at_the_ends_of_the_range_run_or_are_refused_in_a_sentence(
    here, first, field, fast
):
    """Any warning of NumPy's, as of an overflow, is an error here.

    One of them in turn in a fast run, two others by the plain path.
    """
    scene = ROUND if field.startswith(OF_SHAPES) else PLAIN
    for k in (0,) if fast else (1, 2):
        number = AT_THE_ENDS[(first + k) % 4]
        try:
            load_scenario(changed(scene, (field, number)), steps=1, fast=fast).run()
        except QuasistaticError as error:
            sentence = str(error)
            assert sentence.isprintable()


def test_a_step_of_the_smallest_time_is_proved():
    """1 / h is near the largest float64, and h^2, by which the page divides, is 0."""
    run = load_scenario("block_push", ["h=1e-308", "steps=1"]).run()
    assert "1 of 1 steps exact (the backend failed in 1 of them)" in repr(run)


def test_a_time_step_that_overflows_is_named(tmp_path, refused):
    path = scene_written(tmp_path)
    out = tmp_path / "out"
    out.mkdir()
    sentence = refused("run", path, "--set", "h=1e-310", "--out", out)
    assert sentence.endswith("out of the range of float64; use a usual h [s] (got 1e-310)")


def test_a_cloud_that_many_bodies_have_is_read_once(tmp_path):
    (tmp_path / "a.xyz").symlink_to("cloud.xyz")
    (tmp_path / "b.xyz").symlink_to("a.xyz")
    (tmp_path / "c.xyz").write_text("0 0 1\n")
    ball = {"urdf": "ball.urdf", "base": "floating"}
    bodies = {name: {**ball, "cloud": f"{name}.xyz"} for name in "abc"}
    contacts = {"floor": {**SCENE["contacts"]["floor"], "beta": [*bodies]}}
    scene = changed(SCENE, ("bodies", bodies), ("contacts", contacts))
    a, b, c = (pair.beta.shape for pair in load_scenario(scene_written(tmp_path, scene)).pairs)
    assert a is b
    assert a is not c
