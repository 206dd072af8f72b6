"""Figures with matplotlib, which is imported in this part only.

The names below are loaded on first use.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Figure

    from quasistatic_ref.optional.show.figures.animation import animate as animate
    from quasistatic_ref.optional.show.figures.camera import Camera as Camera
    from quasistatic_ref.optional.show.figures.draw import draw_scene as draw_scene
    from quasistatic_ref.optional.show.figures.looks import CAMERA as CAMERA
    from quasistatic_ref.optional.show.figures.moments import moment as moment
    from quasistatic_ref.optional.show.figures.style import figure_style as figure_style
    from quasistatic_ref.optional.show.figures.style import figure_written as figure_written
    from quasistatic_ref.optional.show.figures.style import panels as panels
    from quasistatic_ref.optional.show.figures.style import scaled as scaled
    from quasistatic_ref.optional.show.figures.style import style_file as style_file
    from quasistatic_ref.optional.show.figures.viewer import view_written as view_written

_HOMES = {
    "animation": "animate",
    "camera": "Camera",
    "draw": "draw_scene",
    "looks": "CAMERA",
    "moments": "moment",
    "style": "Figure figure_style figure_written panels scaled style_file",
    "viewer": "view_written",
}
_HOME = {name: home for home, names in _HOMES.items() for name in names.split()}

__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return __all__
