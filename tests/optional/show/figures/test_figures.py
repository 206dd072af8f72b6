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


def test_the_same_figure_has_the_same_bytes_as_png_and_pdf(tmp_path):
    kinds = {".png": b"\x89PNG", ".pdf": b"%PDF"}
    one, other = (figure_written(plt.figure(), tmp_path / name, "blank") for name in ("1", "2"))
    assert [path.suffix for path in one] == list(kinds)
    for path, again in zip(one, other, strict=True):
        assert path.read_bytes().startswith(kinds[path.suffix])
        assert path.read_bytes() == again.read_bytes()


def test_a_camera_from_the_front_sees_y_to_the_right_and_z_upwards():
    seen = Camera(azimuth=0, elevation=0).seen(np.array([[1.0, 2.0, 3.0]]))
    assert_relative(seen, [[2, 3, 1]], ROUNDING)
