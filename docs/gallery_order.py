"""The gallery's scripts on the site: in the order of its README, in the style of all figures."""

import re
from pathlib import Path

from matplotlib import pyplot

from quasistatic_ref.optional.show.figures import style_file


def in_style_of_pages(gallery, script):
    """Set the style of figures before a script runs."""
    pyplot.style.use(["default", style_file("paper")])


class OrderOfReadme:
    """A key by which sphinx-gallery sorts scripts.

    Parameters
    ----------
    folder : str
        The folder of the scripts and their README.
    """

    def __init__(self, folder):
        text = (Path(folder) / "README.md").read_text("utf-8")
        self.names = re.findall(r"^## \[.*\]\((\w+\.py)\)$", text, re.MULTILINE)

    def __call__(self, name):
        """The number of a script among the headings."""
        return self.names.index(name)
