"""Figures with matplotlib, which is imported in this part only."""

import os
import sys

import matplotlib as mpl

if "matplotlib.pyplot" not in sys.modules and not os.environ.get("MPLBACKEND"):
    mpl.use("Agg")  # files need no window; a session that has chosen keeps its choice

from matplotlib.figure import Figure

from quasistatic_ref.optional.show.figures.camera import Camera
from quasistatic_ref.optional.show.figures.looks import CAMERA
from quasistatic_ref.optional.show.figures.style import (
    figure_style,
    figure_written,
    panels,
    scaled,
    style_file,
)

__all__ = [
    "CAMERA",
    "Camera",
    "Figure",
    "figure_style",
    "figure_written",
    "panels",
    "scaled",
    "style_file",
]
