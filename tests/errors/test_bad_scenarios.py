"""Scenario files that cannot be used, each a distinct cause: file, field and value are named."""

import math
import tomllib
from datetime import date
from pathlib import Path

import pytest

from quasistatic_ref import InputError, QuasistaticError, load_scenario
from tests.errors.scene import SCENE, changed, dotted, numeric_fields, scene_written
from tests.files.urdf.urdf_texts import collision, link, robot

CAUSES = tomllib.loads(Path(__file__).with_name("scenarios.toml").read_text("utf-8"))


def test_very_many_bodies_are_refused_before_they_are_read():
    bodies = {f"b{i}": {} for i in range(1001)}
    with pytest.raises(InputError, match=r"^bodies: are more than 1000; whole arrays"):
        load_scenario({"h": 1, "steps": 1, "bodies": bodies})


def test_very_many_pairs_are_refused_before_they_are_made():
    balls = robot(link("a", 224 * collision('<sphere radius="1"/>')))
    bodies = {name: {"urdf": balls} for name in ("one", "two")}
    push = {"alpha": "one", "beta": "two", "mu_v": 0.0, "rows": 4}
    says = r"contacts.push: makes more pairs than 50000 .*; name fewer shapes \(got 50176\)"
    with pytest.raises(InputError, match=says):
        load_scenario({"h": 1, "steps": 1, "bodies": bodies, "contacts": {"push": push}})


@pytest.mark.parametrize("cause", CAUSES)
def test_a_scenario_that_cannot_be_used_is_refused(tmp_path, refused, cause):
    row = {"without": (), "change": {}} | CAUSES[cause]
    changes = *((gone, ...) for gone in row["without"]), *row["change"].items()
    path = scene_written(tmp_path, changed(SCENE, *changes))
    sentence = refused("run", path, "--out", tmp_path / "out")
    assert sentence.startswith(f"{path}: ")
    assert row["field"] in sentence.removeprefix(f"{path}: ").split(": ")[0]
    assert row["words"] in sentence


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
    assert [a.points.shape, c.points.shape] == [(3, 3), (1, 3)]
