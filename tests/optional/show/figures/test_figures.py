"""Figures: what they say and show, and files written whole."""

import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.text import Text

from quasistatic_ref.lab.figures.grasp import grasp_strip
from quasistatic_ref.lab.figures.validation import PICTURES
from quasistatic_ref.lab.grasp import rotations
from quasistatic_ref.optional.show.figures.camera import Camera
from quasistatic_ref.optional.show.figures.looks import CAMERA
from quasistatic_ref.optional.show.figures.style import figure_style, figure_written
from tests.closeness import assert_close, assert_relative
from tests.tolerances import ROUNDING

INSTANTS = (0.3, 1.4, 2.9)
COLUMNS = len(INSTANTS) + 1
SPREAD = np.geomspace(0.05, 60.0, 20)
"""Rotations of other clouds [deg]."""


@pytest.fixture(scope="module")
def figures(grasp, runs):
    with figure_style():
        made = {
            "strip": grasp_strip(grasp, runs, INSTANTS, dict.fromkeys(runs, SPREAD)),
            "rotation": PICTURES["grasp"](rotations(grasp, runs)),
        }
    yield made
    for figure in made.values():
        plt.close(figure)


def texts(figure):
    figure.canvas.draw()
    return [t for t in figure.findobj(Text) if t.get_text().strip() and t.get_visible()]


@pytest.mark.parametrize("name", ["strip", "rotation"])
def test_every_figure_says_its_time_step_and_cone(figures, name):
    words = " ".join(t.get_text() for t in texts(figures[name]))
    assert "h = 10 ms" in words
    assert "friction pyramid" in words


def test_the_strip_has_a_run_in_each_row_and_an_instant_in_each_column(figures):
    axes = figures["strip"].axes
    assert len(axes) == 2 * COLUMNS
    assert [a.get_title() for a in axes[:3]] == [f"{t:g} s" for t in INSTANTS]
    assert [axes[0].get_ylabel(), axes[COLUMNS].get_ylabel()] == ["with_torsion", "without_torsion"]


def test_filled_dots_are_the_contacts_that_bear_load_at_that_instant(figures, runs):
    for row, run in enumerate(runs.values()):
        for column, t in enumerate(INSTANTS):
            axes = figures["strip"].axes[row * COLUMNS + column]
            k = round(t / 0.01) - 1
            force = run.step_forces(k)[:, 2]
            expected = 1e3 * CAMERA.seen(run["beta"][k][force > 1e-3 * force.max()])[:, :2]
            dots = [line for line in axes.lines if line.get_marker() == "o"]
            filled = [dot for dot in dots if dot.get_markerfacecolor() != "white"]
            found = np.reshape([dot.get_xydata()[0] for dot in filled], (-1, 2))
            assert_close(found, expected, ROUNDING)


def plain_figure():
    figure, axes = plt.subplots()
    axes.plot([0, 1], [0, 1])
    return figure


def test_a_figure_is_written_as_png_and_pdf_and_closed(tmp_path):
    before = plt.get_fignums()
    paths = figure_written(plain_figure(), tmp_path / "new", "layer")
    assert [p.name for p in paths] == ["layer.png", "layer.pdf"]
    assert paths[0].read_bytes().startswith(b"\x89PNG")
    assert paths[1].read_bytes().startswith(b"%PDF")
    assert sorted(p.name for p in (tmp_path / "new").iterdir()) == ["layer.pdf", "layer.png"]
    assert plt.get_fignums() == before
    for path, again in zip(paths, figure_written(plain_figure(), tmp_path, "layer"), strict=True):
        assert path.read_bytes() == again.read_bytes()


def test_a_camera_from_the_front_sees_y_to_the_right_and_z_upwards():
    seen = Camera(azimuth=0, elevation=0).seen(np.array([[1.0, 2.0, 3.0]]))
    assert_relative(seen, [[2, 3, 1]], ROUNDING)
