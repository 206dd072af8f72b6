"""Figures with matplotlib, which is imported in this part only."""

import os
import sys

import matplotlib as mpl

if "matplotlib.pyplot" not in sys.modules and not os.environ.get("MPLBACKEND"):
    mpl.use("Agg")  # files need no window; a session that has chosen keeps its choice

from matplotlib.figure import Figure

from quasistatic_ref.optional.show.figures.animation import animate
from quasistatic_ref.optional.show.figures.camera import Camera
from quasistatic_ref.optional.show.figures.contact_pictures import cone_with_load, stick_slip_map
from quasistatic_ref.optional.show.figures.draw import draw_scene, draw_scenes
from quasistatic_ref.optional.show.figures.looks import CAMERA
from quasistatic_ref.optional.show.figures.moments import moment
from quasistatic_ref.optional.show.figures.style import (
    figure_style,
    figure_written,
    panels,
    scaled,
    style_file,
)
from quasistatic_ref.optional.show.figures.viewer import view_written

__all__ = [
    "CAMERA",
    "Camera",
    "Figure",
    "animate",
    "cone_with_load",
    "draw_scene",
    "draw_scenes",
    "figure_style",
    "figure_written",
    "moment",
    "panels",
    "scaled",
    "stick_slip_map",
    "style_file",
    "view_written",
]
