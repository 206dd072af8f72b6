"""Figures of contacts and of moments of a run: ``qr.figures``, each loaded on first use."""

from importlib import import_module

from quasistatic_ref import homes
from quasistatic_ref.parts import needing

_HOME = homes(__file__)

__all__ = sorted(_HOME)


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    with needing(f"figures.{name}"):
        return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return __all__
