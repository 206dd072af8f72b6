"""Six figures look as they did: ``pytest --mpl-generate-path=FOLDER`` draws what is committed.

Whoever changes a figure looks at the new image before it is committed.
"""

import numpy as np
import pytest

from docs.drawings import cone_surfaces, contact_geometry, corner_loads
from quasistatic_ref import load_scenario
from quasistatic_ref.lab.figures.grasp import grasp_strip
from quasistatic_ref.lab.figures.validation import PICTURES
from quasistatic_ref.lab.grasp import rotations
from quasistatic_ref.optional.show.figures import figure_style, panels, style_file
from quasistatic_ref.optional.show.figures.draw import draw_scene
from quasistatic_ref.optional.show.figures.looks import CAMERA
from quasistatic_ref.optional.show.figures.moments import moment

SPREAD = np.geomspace(0.05, 60.0, 20)
"""Rotations of other clouds [deg]."""
looks_as_committed = pytest.mark.mpl_image_compare(
    baseline_dir="images",
    style=[style_file("paper"), {"savefig.bbox": None}],  # a whole page: sizes do not vary
    savefig_kwargs={"dpi": 60},
    # Root mean square over all pixels, of 255: a line in another colour makes 5, a missing label
    # 4. Text is the same everywhere, because matplotlib's wheels bring their own FreeType.
    tolerance=2,
)


@looks_as_committed
def test_strip_of_the_grasp(grasp, runs):
    with figure_style():
        return grasp_strip(grasp, runs, (0.3, 1.4, 2.9), dict.fromkeys(runs, SPREAD))


@looks_as_committed
def test_rotation_of_the_bunny(grasp, runs):
    with figure_style():
        return PICTURES["grasp"](rotations(grasp, runs))


@looks_as_committed
def test_block_on_an_incline():
    scenario = load_scenario("block_incline", ["steps=30"], fast=True)
    with figure_style():
        figure, (axes,) = panels(4.6, 4.0)
        draw_scene(axes, moment(scenario, scenario.run(progress=False), -1), view=CAMERA)
        return figure


@looks_as_committed
def test_surfaces_of_cones():
    with figure_style():
        return cone_surfaces.figure()


@looks_as_committed
def test_geometry_of_a_contact():
    with figure_style():
        return contact_geometry.figure()


@looks_as_committed
def test_loads_of_corners():
    with figure_style():
        return corner_loads.figure()
