"""Styles of figures: files of rcParams that a block sets and leaves again."""

import numpy as np
import pytest
from matplotlib import pyplot as plt

from quasistatic_ref import InputError
from quasistatic_ref.optional.show.figures import figure_style, figure_written, style_file
from quasistatic_ref.optional.show.figures.style import STYLES, scaled


def test_a_style_is_that_of_the_enclosing_block_and_is_left_again():
    before = dict(plt.rcParams)
    with figure_style(), figure_style("slides"), figure_style():
        assert plt.rcParams["font.size"] == 16
        np.testing.assert_allclose(scaled(1.8), 1.8 * 16 / 9)
    with figure_style():
        assert plt.rcParams["font.size"] == 9
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


def test_the_same_figure_has_the_same_bytes_as_png_and_pdf(tmp_path):
    kinds = {".png": b"\x89PNG", ".pdf": b"%PDF"}
    one, other = (figure_written(plt.figure(), tmp_path / name, "blank") for name in ("1", "2"))
    assert [path.suffix for path in one] == list(kinds)
    for path, again in zip(one, other, strict=True):
        assert path.read_bytes().startswith(kinds[path.suffix])
        assert path.read_bytes() == again.read_bytes()
