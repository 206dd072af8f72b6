"""What the page for roboticists says comes of its blocks, alone in an empty folder."""

import runpy
import shlex

import numpy as np
import pytest
from matplotlib import image
from matplotlib import pyplot as plt
from PIL import Image

from quasistatic_ref import load_trajectory
from quasistatic_ref.cli.main import main
from tests.pages import ROOT, fenced, named_files
from tests.tolerances import CLOSED_FORM

pytestmark = pytest.mark.long  # 24 s; its commands are those of other pages


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The page's files in an empty folder, and all its commands run there, in its order."""
    place = tmp_path_factory.mktemp("first_scene")
    page = (ROOT / "docs" / "guides" / "first_scene.md").read_text("utf-8")
    for name, text in named_files(page).items():
        (place / name).write_text(text, "utf-8")
    commands, *_ = fenced(page, "sh")
    with pytest.MonkeyPatch.context() as patch, plt.rc_context():
        patch.chdir(place)
        for line in commands.splitlines():
            program, *words = shlex.split(line)
            if program == "python":
                runpy.run_path(*words)
            else:
                assert program == "quasistatic-ref"
                quicker = ["--fast"] if words[0] == "run" else []  # the same bits
                assert main([*words, *quicker]) == 0
    return place


def test_the_can_rises_with_the_lift_less_the_stretch_of_the_spring(folder):
    run = load_trajectory(folder / "results" / "scene.npz")
    assert run.header.findings == ()
    assert set(run["certificate"]) == {"exact"}
    mass = 0.2
    gravity = 9.81
    h = 0.02
    K_lift = 2000.0
    rise = 0.03
    speed = 0.01
    drag = mass * speed / h  # (R13); the lift still moves in the last step
    # Balance of the lift: K (target - lift) = m g + m v / h. The can goes with the fingers, but
    # for what they lifted before it hung in them: nothing, the target stands still until t = 1.
    expected = rise - (mass * gravity + drag) / K_lift
    can = run["q"][-1][3 + 2] - run["q"][0][3 + 2]
    assert abs(can - expected) < CLOSED_FORM
    assert round(1e3 * can) == 29  # mm, as the page says
    assert np.round(1e3 * mass * gravity / K_lift) == 1


def test_the_picture_shows_something(folder):
    pixels = image.imread(folder / "picture.png")
    with Image.open(folder / "film.gif") as film:
        assert film.n_frames > 10
    assert 0.02 < float((pixels[..., :3].min(axis=2) < 0.9).mean()) < 0.9
