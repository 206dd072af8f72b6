"""Figures: what they say and show, and files written whole."""

import numpy as np
from matplotlib import pyplot as plt

from quasistatic_ref.lab.figures.grasp import grasp_strip
from quasistatic_ref.optional.show.figures.camera import Camera
from quasistatic_ref.optional.show.figures.looks import CAMERA
from quasistatic_ref.optional.show.figures.style import figure_style, figure_written
from tests.closeness import assert_close, assert_relative
from tests.tolerances import ROUNDING

INSTANTS = (0.3, 1.4, 2.9)
SPREAD = np.geomspace(0.05, 60.0, 20)
"""Rotations of other clouds [deg]."""


def test_filled_dots_are_the_contacts_that_bear_load_at_that_instant(grasp, runs):
    with figure_style():
        figure = grasp_strip(grasp, runs, INSTANTS, dict.fromkeys(runs, SPREAD))
    for row, run in enumerate(runs.values()):
        for column, t in enumerate(INSTANTS):
            axes = figure.axes[row * (len(INSTANTS) + 1) + column]
            k = round(t / 0.01) - 1
            force = run.step_forces(k)[:, 2]
            expected = 1e3 * CAMERA.seen(run["beta"][k][force > 1e-3 * force.max()])[:, :2]
            dots = [line for line in axes.lines if line.get_marker() == "o"]
            filled = [dot for dot in dots if dot.get_markerfacecolor() != "white"]
            found = np.reshape([dot.get_xydata()[0] for dot in filled], (-1, 2))
            assert_close(found, expected, ROUNDING)
    plt.close(figure)


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
