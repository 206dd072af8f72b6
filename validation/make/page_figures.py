"""The still figures of pages: ``python -m validation.make.page_figures``.

Each is drawn by the module of its name in docs/drawings/, and committed, so that pages show it on a
code host, too. ``--style slides`` draws with larger text: those of docs/slides/figures.
"""

from importlib import import_module
from pathlib import Path

from quasistatic_ref.optional.show.figures.style import figure_style, figure_written
from validation.tools.scripts import ROOT, script_options


def main() -> None:
    """Draw all."""
    options = script_options(__doc__, out=Path("page_figures"), style="paper")
    with figure_style(options.style):
        for path in sorted((ROOT / "docs" / "drawings").glob("*.py")):
            drawing = import_module(f"docs.drawings.{path.stem}")
            if hasattr(drawing, "figure"):
                figure_written(drawing.figure(), options.out, path.stem)


if __name__ == "__main__":
    main()
