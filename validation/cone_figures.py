"""Draw the figures of docs/cones.md: ``python -m validation.cone_figures [FOLDER]``."""

import sys

from quasistatic_ref.figures.cones import limit_surfaces, pinch_thresholds
from quasistatic_ref.figures.style import figure_written

if __name__ == "__main__":
    folder = sys.argv[1] if len(sys.argv) > 1 else "docs/figures"
    for name, figure in (("cones", limit_surfaces()), ("cone_pinch", pinch_thresholds())):
        for path in figure_written(figure, folder, name):
            print(path)
