"""Figures in a paper of two columns, on slides and in a grid; all: validation/tools/restyled.py."""

import inspect

import pytest
from matplotlib import pyplot as plt

from tests.extras import GALLERY
from validation.tools.restyled import FIGURES, GRID, drawer, in_styles

QUICK = ("cone_surfaces", "corner_loads")
"""Three panels each, surfaces and drawings. The others take minutes."""


@pytest.mark.parametrize("name", QUICK)
def test_a_figure_is_legible_in_columns_slides_posters_and_grids(name):
    made = in_styles(name)
    widths = {what: page.get_size_inches()[0] for what, (page, _) in made.items()}
    assert {what: found for what, (_, found) in made.items() if found} == {}
    assert widths["two_columns"] <= 3.4
    assert widths["grid"] == GRID[0]
    assert widths["slides"] > 6.3
    for page, _ in made.values():
        plt.close(page)


@pytest.mark.parametrize("name", [*GALLERY, *FIGURES])
def test_every_figure_takes_axes_first_and_physical_parameters_by_name(name):
    first, *others = inspect.signature(drawer(name)).parameters.values()
    assert first.name == "ax"
    assert first.default is None
    assert all(p.kind is p.KEYWORD_ONLY and p.default is not p.empty for p in others)
    assert others
