"""The viewer's commands are the trajectory; validation/tools/check_viewer.py tries the page."""

import json
import pickle
import re
import sys

import numpy as np
import pytest

from quasistatic_ref import Body, Box, InputError, Sphere, System, load_scenario
from quasistatic_ref.optional.show.figures import viewer
from quasistatic_ref.optional.show.figures.draw import force_scale
from quasistatic_ref.optional.show.figures.looks import ROBOTS
from quasistatic_ref.optional.show.figures.moments import frames
from quasistatic_ref.optional.show.figures.surfaces import normals, surface_points, triangles
from quasistatic_ref.optional.show.figures.viewer import (
    FRAMES_PER_SECOND,
    LONGEST,
    scene_commands,
    view_written,
)
from quasistatic_ref.optional.show.figures.visuals import visuals
from quasistatic_ref.simulate.scene import Scene
from tests.model.urdf.urdf_texts import collision, joint, link, robot
from tests.tolerances import ROUNDING

NANOMETRE = 1e-9  # what is written


@pytest.fixture(scope="module")
def pushed():
    scenario = load_scenario("block_push", ["steps=40", "h=0.02"], fast=True)
    return scenario, scenario.run(progress=False)


@pytest.fixture(scope="module")
def commands(pushed):
    moments, fps = frames(*pushed, FRAMES_PER_SECOND)
    return moments, scene_commands(pushed[0], moments, fps, 0.1, 0.01)


def animations(commands):
    return commands[-1]["animations"]


def tracks(commands, path):
    (clip,) = [c["clip"] for c in animations(commands) if c["path"] == path]
    return {t["name"]: np.array([key["value"] for key in t["keys"]]) for t in clip["tracks"]}


def test_links_move_as_in_the_trajectory(commands, pushed):
    scenario, run = pushed
    _, sent = commands
    link = scenario.system.link("block")
    found = tracks(sent, f"/links/{link}")
    poses = [scenario.system.kinematics(q) for q in run["q"][:-1:2]]
    np.testing.assert_allclose(found[".position"], [p.t[link] for p in poses], atol=NANOMETRE)
    # A turn by R about w: quaternions [x y z w], here of hardly any turn.
    np.testing.assert_allclose(np.abs(found[".quaternion"][:, 3]), 1.0, atol=1e-6)


def test_forces_start_at_beta_and_are_as_long_as_they_are_strong(commands, pushed):
    _, run = pushed
    moments, sent = commands
    for j in range(8):
        found = tracks(sent, f"/forces/{j}")
        np.testing.assert_allclose(found[".position"], run["beta"][::2, j], atol=NANOMETRE)
        force = np.linalg.norm(run.forces[::2, j, :3], axis=1)
        length = np.maximum(0.01 * force, NANOMETRE)
        np.testing.assert_allclose(found[".scale"][:, 2], length, atol=NANOMETRE)
    assert force_scale(moments, None, 0.1, LONGEST) * max(
        np.linalg.norm(c.force) for m in moments for c in m.contacts
    ) <= 0.05 * (1 + ROUNDING)


def test_the_page_holds_the_viewer_and_the_commands_and_no_address(pushed, tmp_path, monkeypatch):
    monkeypatch.setattr(viewer, "viewer_script", lambda: "/* the viewer */")
    scenario, run = pushed
    page = view_written(run, tmp_path / "run.html").read_text()
    assert "/* the viewer */" in page
    (sent,) = re.findall(r"const commands = (.*);", page)
    assert json.loads(sent)[-1]["type"] == "set_animation"
    assert "://" not in page
    assert "1 N is 10 mm" in page
    again = view_written(scenario, tmp_path / "again.html", run).read_text()
    assert again.replace("block_push", "scene") == page


def test_a_scene_made_in_python_and_one_without_a_run_have_pages(pushed, tmp_path, monkeypatch):
    monkeypatch.setattr(viewer, "viewer_script", lambda: "")
    scenario, run = pushed
    page = view_written(scenario.simulator(), tmp_path / "scene.html").read_text()
    assert "1 N is" not in page  # nothing is known of forces
    (sent,) = re.findall(r"const commands = (.*);", page)
    assert not [c for c in json.loads(sent) if c.get("path", "").startswith("/forces")]
    from_file = pickle.loads(pickle.dumps(run))
    with pytest.raises(InputError, match=r"is from a file; give its scenario or simulator first"):
        view_written(from_file, tmp_path / "other.html")
    with pytest.raises(InputError, match="path: must be a file; give what is shown, then the file"):
        view_written(scenario, run, tmp_path / "other.html")


LOOKS = robot(
    '<material name="red"><color rgba="1 0 0 1"/></material>',
    link(
        "box",
        collision('<box size="0.1 0.1 0.1"/>')
        + '<visual><origin xyz="0 0 0.5"/><geometry><box size="0.2 0.4 0.6"/></geometry>'
        '<material name="red"/></visual>'
        '<visual><geometry><mesh filename="missing.stl"/></geometry></visual>',
    ),
    link("hat", '<visual><geometry><sphere radius="0.1"/></geometry></visual>'),
    joint("neck", "box", "hat"),
)


def test_visual_elements_are_drawn_in_their_colours_and_missing_meshes_are_not():
    system = System([Body("crate", LOOKS, base="floating", actuated=["neck"])])
    found, hat = visuals(Scene(system, ()))
    assert (found.link, found.colour) == (system.link("crate/box"), "#ff0000")
    assert (hat.link, hat.colour) == (system.link("crate/hat"), ROBOTS[0])
    np.testing.assert_allclose(found.corners.min(axis=0), [-0.1, -0.2, 0.2], atol=ROUNDING)
    np.testing.assert_allclose(found.corners.max(axis=0), [0.1, 0.2, 0.8], atol=ROUNDING)


def test_surfaces_are_lit_as_round_where_they_are():
    """A sphere's normals are its radii; a box's those of its faces."""
    corners = triangles(surface_points(Sphere(1.0), 32, 12))
    assert np.einsum("ci,ci->c", normals(corners), corners).min() > np.cos(2 * np.pi / 32)
    corners = triangles(surface_points(Box((1.0, 2.0, 3.0))))
    assert np.abs(normals(corners)).max(axis=1) == pytest.approx(1.0)


def test_without_meshcat_a_sentence_says_what_to_install(tmp_path, monkeypatch, cli):
    monkeypatch.setattr(viewer, "find_spec", lambda name: None)
    arguments = ["run", "block_push", "--view", "--set", "steps=2", "--out", tmp_path]
    assert "pip install 'quasistatic-ref[view]'" in cli(*arguments, status=2).err
    assert list(tmp_path.iterdir()) == []  # refused before the run


def test_a_run_with_view_says_where_the_page_is(tmp_path, monkeypatch, cli):
    monkeypatch.setattr(viewer, "viewer_script", lambda: "")
    arguments = ["run", "block_push", "--view", "--set", "steps=2", "--out", tmp_path]
    assert json.loads(cli(*arguments, "--json").out)["view"] == str(tmp_path / "block_push.html")
    assert (tmp_path / "block_push.html").is_file()
    assert "meshcat" not in sys.modules


def test_a_run_without_steps_has_nothing_to_show(pushed):
    scenario, run = pushed
    empty = type(run)(run.header, {**run.arrays, "t": run["t"][:0]})
    with pytest.raises(InputError, match="has no steps"):
        frames(scenario, empty, FRAMES_PER_SECOND)
