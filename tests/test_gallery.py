"""The scripts of docs/gallery: their assertions hold, and their figures look as committed.

``python -m tests.test_gallery [NAME...]`` draws the committed images again. Whoever does so looks
at them.
"""

import ast
import re
import runpy
import sys

import matplotlib
import matplotlib.pyplot as plt
import pytest
from matplotlib.testing.compare import compare_images

from quasistatic_ref.optional.show.figures import figure_style
from tests.extras import marked_as_long
from tests.meta.remedies import assert_alike
from tests.pages import ROOT

GALLERY = ROOT / "docs" / "gallery"
SCRIPTS = sorted(GALLERY.glob("*.py"))
IMPORTED = {"matplotlib.pyplot", "numpy", "quasistatic_ref", "time"}
SHORT = {"spun_sphere"}
"""The script that README's line runs; the others are long."""
DPI = 100
TOLERANCE = 6
"""Root mean square over all pixels, of 255; an empty figure is off by some 30."""


def drawn(script, path):
    """Run a script without a window, and write its figure in the style of all pages."""
    with pytest.MonkeyPatch.context() as patch, figure_style():
        patch.setattr(plt, "show", lambda: None)
        runpy.run_path(str(script), run_name="__main__")
        figure = plt.gcf()
        figure.savefig(path, dpi=DPI, metadata={"Software": None})
        plt.close(figure)
    return path


@pytest.mark.parametrize("script", marked_as_long(SCRIPTS, SHORT))
def test_a_script_runs_and_draws_what_is_committed(script, tmp_path):
    image = drawn(script, tmp_path / f"{script.stem}.png")
    if matplotlib.__version_info__ >= (3, 11):  # earlier ones set text some pixels away
        assert compare_images(str(GALLERY / image.name), str(image), TOLERANCE) is None


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_script_imports_public_names_alone_and_asserts_its_number(script):
    nodes = list(ast.walk(ast.parse(script.read_text("utf-8"))))
    imported = {name.name for node in nodes if isinstance(node, ast.Import) for name in node.names}
    assert imported <= IMPORTED
    assert not any(isinstance(node, ast.ImportFrom) for node in nodes)
    assert any(isinstance(node, ast.Assert) for node in nodes)


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_figure_is_drawn_in_one_block(script):
    """The site keeps what is drawn at the end of each block: a figure of two is half drawn."""
    *earlier, last = script.read_text("utf-8").split("\n# %%\n")
    assert "plt.subplots(" in last
    assert not any("plt." in block for block in earlier)


def test_the_page_shows_every_script():
    page = (GALLERY / "README.md").read_text("utf-8")
    for ending in ("py", "png"):
        assert_alike(
            [script.stem for script in SCRIPTS],
            re.findall(rf"\]\((\w+)\.{ending}\)", page),
            f"docs/gallery/README.md does not show {{}}.{ending}: add it",
            f"docs/gallery/README.md shows {{}}.{ending}, which is not there: remove it",
        )


if __name__ == "__main__":
    for name in sys.argv[1:] or [script.stem for script in SCRIPTS]:
        drawn(GALLERY / f"{name}.py", GALLERY / f"{name}.png")
