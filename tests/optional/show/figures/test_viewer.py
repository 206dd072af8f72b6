"""What meshcat is told is the trajectory; validation/tools/check_in_browser.py opens the page."""

import pickle
import sys

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import Body, InputError, System, load_scenario, save_view
from quasistatic_ref.optional.show.figures.draw import force_scale
from quasistatic_ref.optional.show.figures.looks import ROBOTS
from quasistatic_ref.optional.show.figures.moments import frames
from quasistatic_ref.optional.show.figures.viewer import (
    FRAMES_PER_SECOND,
    LONGEST,
    scene_drawn,
    viewer_package,
)
from quasistatic_ref.optional.show.figures.visuals import visuals
from quasistatic_ref.simulate.scene import Scene
from tests.closeness import assert_close, assert_relative, assert_same, assert_within
from tests.files.urdf.urdf_texts import collision, joint, link, robot
from tests.tolerances import ROUNDING

CENTRE = np.array([0.1, 0.2, 0.3])


class Commands(list):
    """What a visualizer sends, in place of its server."""

    def send(self, command):
        """Keep a command as it would be sent."""
        self.append(command.lower())


@pytest.fixture(scope="module")
def pushed():
    scenario = load_scenario("block_push", ["steps=40", "h=0.02"], fast=True)
    return scenario, scenario.run()


@pytest.fixture(scope="module")
def commands(pushed):
    moments, fps = frames(*pushed, FRAMES_PER_SECOND)
    sent = Commands()
    scene_drawn(viewer_package().Visualizer(window=sent), moments, fps, CENTRE, 0.1, 0.01)
    return moments, sent


def tracks(commands, path):
    (clip,) = [c["clip"] for c in commands[-1]["animations"] if c["path"] == f"/meshcat/{path}"]
    return {t["name"]: np.array([key["value"] for key in t["keys"]]) for t in clip["tracks"]}


def test_links_move_as_in_the_trajectory(commands, pushed):
    scenario, run = pushed
    _, sent = commands
    link = scenario.system.link("block")
    track = tracks(sent, f"links/{link}")
    poses = [scenario.system.kinematics(q) for q in run["q"][:-1:2]]
    assert_same(track[".position"], [p.t[link] for p in poses])
    R = Rotation.from_quat(track[".quaternion"]).as_matrix()
    assert_within(R, [p.R[link] for p in poses])
    (whole,) = [
        c["matrix"] for c in sent if c["type"] == "set_transform" and c["path"] == "/meshcat"
    ]
    assert whole[12:15] == (-CENTRE).tolist()


def test_forces_start_at_beta_along_the_force_and_are_as_long_as_it_is_strong(commands, pushed):
    _, run = pushed
    moments, sent = commands
    for j, _ in enumerate(run.pair_names):
        track = tracks(sent, f"forces/{j}")
        assert_same(track[".position"], run["beta"][::2, j])
        force = np.linalg.norm(run.forces[::2, j, :3], axis=1)
        length = np.maximum(0.01 * force, 1e-9)
        assert_relative(track[".scale"][:, 1], length)
        along = Rotation.from_quat(track[".quaternion"]).apply([0.0, 1.0, 0.0])
        world = np.array([moment.contacts[j].force for moment in moments])
        strong = force > 0
        arrows = force[strong, None] * along[strong]
        assert_close(arrows, world[strong])
    assert force_scale(moments, None, 0.1, LONGEST) * max(
        np.linalg.norm(c.force) for m in moments for c in m.contacts
    ) <= 0.05 * (1 + ROUNDING)


def test_one_state_of_a_contact_is_visible_at_a_time(commands):
    moments, sent = commands
    states = ("sticking", "sliding", "apart")
    for j in range(8):
        for kind in ("contacts", "forces"):
            visible = [tracks(sent, f"{kind}/{j}/{state}")[".visible"] for state in states]
            shown = [states[k] for k in np.argmax(visible, axis=0)]
            assert shown == [moment.contacts[j].state for moment in moments]
            assert np.sum(visible, axis=0).tolist() == [1] * len(moments)


def test_a_page_says_what_it_shows(pushed, tmp_path, capfd):
    scenario, run = pushed
    page = save_view(tmp_path / "run.html", scenario, run).read_text()
    assert "<title>block_push</title>" in page
    assert "1 N is 10 mm" in page
    light = load_scenario("block_push", ["steps=1", "record=light"], fast=True).run()
    assert "1 N of lam is " in save_view(tmp_path / "light.html", light).read_text()
    assert capfd.readouterr() == ("", "")
    still = save_view(tmp_path / "scene.html", scenario.simulator()).read_text()
    assert "<title>scene</title>" in still
    assert "1 N is" not in still  # nothing is known of forces
    assert len(still) < len(page)


def test_a_run_that_cannot_be_shown_is_refused(pushed, tmp_path):
    scenario, run = pushed
    from_file = pickle.loads(pickle.dumps(run))
    with pytest.raises(InputError, match=r"is from a file; give its scenario or simulator first"):
        save_view(tmp_path / "other.html", from_file)
    empty = type(run)(run.header, {**run.arrays, "t": run["t"][:0]})
    with pytest.raises(InputError, match="has no steps"):
        save_view(tmp_path / "other.html", scenario, empty)


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
    assert_within(found.corners.min(axis=0), [-0.1, -0.2, 0.2])
    assert_within(found.corners.max(axis=0), [0.1, 0.2, 0.8])


def test_without_meshcat_a_sentence_says_what_to_install(tmp_path, monkeypatch, cli):
    monkeypatch.setitem(sys.modules, "meshcat", None)
    said = cli("run block_push --view --set steps=2 --out", tmp_path, status=2).err
    assert "pip install 'quasistatic-ref[view]'" in said
    assert list(tmp_path.iterdir()) == []  # refused before the run
