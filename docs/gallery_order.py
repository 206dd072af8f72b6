"""The order of the gallery's scripts on the site: that of their headings in its README."""

import re
from pathlib import Path


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
