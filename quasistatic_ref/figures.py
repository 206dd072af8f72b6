"""A moment of a run, to be drawn: ``qr.figures``, loaded on first use."""

from importlib import import_module
from typing import TYPE_CHECKING

from quasistatic_ref.parts import OPTIONAL, needing

_HOME = {"moment": "moments"}

__all__ = sorted(_HOME)

if TYPE_CHECKING:
    from quasistatic_ref.optional.show.figures.moments import moment as moment
else:

    def __getattr__(name: str) -> object:
        if name not in _HOME:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        with needing(f"figures.{name}"):
            return getattr(import_module(f"{OPTIONAL}.show.figures.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return __all__
