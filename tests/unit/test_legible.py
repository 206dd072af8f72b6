"""What is not legible is found: each fault is planted in a figure that has no other."""

import numpy as np
import pytest
from matplotlib import pyplot as plt

from quasistatic_ref.errors import InputError
from quasistatic_ref.figures import faults, figure_style, panels, style_file, styled
from quasistatic_ref.figures.style import PAGE, STYLES, sized


@pytest.fixture
def page():
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


HARMLESS = {
    "categories need no unit": lambda a: (
        a.set_xticks([0, 1], ["+d1", "solve"]),
        a.set_xlabel(""),
    ),
    "nothing at the ticks": lambda a: (a.set_xticks([]), a.set_xlabel("")),
    "a marker tells lines apart": lambda a: (same_lines(a), a.lines[1].set_marker("o")),
    "black and white": lambda a: (
        a.bar([0], [1], color="black", label="a"),
        a.bar([0], [1], color="white", label="b"),
    ),
    "a hatch": lambda a: (
        a.bar([0], [1], color="#5588aa", label="a"),
        a.bar([0], [1], color="#aa7755", hatch="//", label="b"),
    ),
    "a family of equal lines": lambda a: a.plot([[0, 0], [1, 1]], [[0, 1], [1, 2]], "k-."),
}


@pytest.mark.parametrize("plant", HARMLESS.values(), ids=HARMLESS)
def test_what_can_be_read_is_no_fault(page, plant):
    figure, axes = page
    plant(axes)
    assert faults(figure) == []


def test_shared_axes_are_labelled_once():
    with figure_style():
        figure, (above, below) = plt.subplots(2, 1, figsize=sized(4.6, 3), sharex=True)
        for axes in (above, below):
            axes.plot([0, 1], [0, 1])
            axes.set_ylabel("force [N]")
        below.set_xlabel("time t [s]")
    assert faults(figure) == []
    below.set_xlabel("")
    assert len(faults(figure)) == 1
    plt.close(figure)


def test_slides_have_larger_figures_and_still_larger_text():
    with figure_style("slides"):
        figure, (axes,) = panels(4.6, 2.8)
        text = axes.set_xlabel("time t [s]")
        axes.set_ylabel("force [N]")
    np.testing.assert_allclose(figure.get_size_inches(), STYLES["slides"] * np.array([4.6, 2.8]))
    assert text.get_fontsize() > 9 * STYLES["slides"]
    assert faults(figure, "slides") == []
    plt.close(figure)


def test_a_style_is_that_of_the_enclosing_block_and_is_left_again():
    before = dict(plt.rcParams)
    size = styled(lambda: plt.rcParams["font.size"])
    assert size() == 9
    with figure_style("slides"):
        assert size() == 16
        assert sized(1, 2) == (1.6, 3.2)
    assert sized(1, 2) == (1, 2)
    assert dict(plt.rcParams) == before


@pytest.mark.parametrize("name", STYLES)
def test_a_style_is_a_file_that_pyplot_reads(name):
    with plt.style.context(style_file(name)):
        cycle = plt.rcParams["axes.prop_cycle"].by_key()
        assert plt.rcParams["pdf.fonttype"] == 42  # outlines that journals accept
    assert len(cycle["color"]) == len(set(map(str, cycle["linestyle"]))) == 6


def test_an_unknown_style_is_refused_with_the_nearest():
    nearest = pytest.raises(InputError, match="is no style; did you mean 'slides'")
    with nearest, figure_style("slide"):
        pass
