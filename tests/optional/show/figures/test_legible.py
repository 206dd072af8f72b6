"""What is not legible is found: each fault is planted in a figure that has no other."""

import numpy as np
import pytest
from matplotlib import pyplot as plt

from quasistatic_ref import InputError
from quasistatic_ref.optional.show.figures import figure_style, panels, style_file
from quasistatic_ref.optional.show.figures.style import PAGE, STYLES, scaled, sized
from tests.legible import faults


@pytest.fixture
def page():
    with figure_style("paper"):
        figure, (axes,) = panels(4.6, 2.8)
        axes.plot([0, 1], [0, 1], label="one")
        axes.plot([0, 1], [1, 0], label="two")
        axes.set(xlabel="time t [s]", ylabel="force [N]")
    yield figure, axes
    plt.close(figure)


def test_a_legible_figure_has_no_faults(page):
    assert faults(page[0]) == []


def same_lines(axes):
    axes.lines[1].set_linestyle(axes.lines[0].get_linestyle())


def same_patches(axes):
    axes.bar([0, 1], [1, 1], color="#5588aa", label="blue")
    axes.bar([0, 1], [1, 1], color="#aa7755", label="brown")


def same_dots(axes):
    axes.scatter([0], [0], color="#5588aa", label="blue")
    axes.scatter([1], [0], color="#aa7755", label="brown")


PLANTED = {
    "no unit": (lambda a: a.set_xlabel("time"), "of x does not end with a"),
    "no label": (lambda a: a.set_ylabel(""), "of y does not end with a"),
    "no unit on a logarithmic axis": (
        lambda a: a.set(yscale="log", ylabel="force"),
        "of y does not end with a",
    ),
    "small text": (lambda a: a.text(0, 0, "tiny", fontsize=6), "'tiny' is printed at 6.0 pt"),
    "a figure wider than a page": (
        lambda a: a.figure.set_size_inches(PAGE * 9 / 7, 3),
        "is printed at 6.",
    ),
    "text beyond the figure": (
        lambda a: a.set_xlabel("a label that is longer than the figure is wide, " * 2 + "[s]"),
        "of 460 pixels across",
    ),
    "text on text": (
        lambda a: (a.text(0.5, 0.5, "under [m]"), a.text(0.52, 0.51, "over [m]")),
        "'under [m]' and 'over [m]' lie on each other",
    ),
    "lines": (same_lines, "the lines 'one' and 'two' differ in colour only"),
    "patches": (same_patches, "the patches 'blue' and 'brown' differ in colour only"),
    "dots": (same_dots, "the dots 'blue' and 'brown' differ in colour only"),
}


@pytest.mark.parametrize(("plant", "says"), PLANTED.values(), ids=PLANTED)
def test_a_planted_fault_is_found(page, plant, says):
    figure, axes = page
    plant(axes)
    found = faults(figure)
    assert found
    assert all(says in fault for fault in found), found


def test_a_style_is_that_of_the_enclosing_block_and_is_left_again():
    before = dict(plt.rcParams)
    with figure_style(), figure_style("slides"), figure_style():
        assert plt.rcParams["font.size"] == 16
        np.testing.assert_allclose(scaled(1.8), 1.8 * 16 / 9)
    with figure_style():
        assert plt.rcParams["font.size"] == 9
        assert sized(1, 2) == (1, 2)
    assert dict(plt.rcParams) == before


@pytest.mark.parametrize("name", STYLES)
def test_a_style_is_a_file_that_pyplot_reads(name):
    with plt.style.context(style_file(name)):
        cycle = plt.rcParams["axes.prop_cycle"].by_key()
        assert plt.rcParams["pdf.fonttype"] == 42  # outlines that journals accept
        assert plt.rcParams["svg.fonttype"] == "none"  # text as text
    assert len(cycle["color"]) == len(set(map(str, cycle["linestyle"]))) == 6


def test_an_unknown_style_is_refused_with_the_nearest():
    nearest = pytest.raises(InputError, match="is not a style; did you mean 'slides'")
    with nearest, figure_style("slide"):
        pass
