"""The figures of the gallery: scripts that come along, each of which ends in one."""

import runpy
import warnings
from pathlib import Path

from matplotlib import pyplot as plt

from quasistatic_ref.files.resources import data_folder
from quasistatic_ref.optional.show.figures import Figure


def gallery_scripts() -> dict[str, Path]:
    """Each script by its name."""
    folder = data_folder("docs/gallery", "lab/gallery")
    return {path.stem: path for path in sorted(folder.glob("*.py"))}


def gallery_figure(script: Path) -> Figure:
    """The figure in which a script ends; what it asserts holds, or it raises AssertionError.

    Parameters
    ----------
    script : Path
    """
    before = plt.get_fignums()
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*non-interactive", UserWarning)  # its plt.show()
        runpy.run_path(str(script))
    (number,) = set(plt.get_fignums()) - set(before)
    return plt.figure(number)
