"""Objects that show themselves: in words where they are printed, as HTML in a notebook."""

from collections.abc import Callable
from dataclasses import fields, is_dataclass

from quasistatic_ref.parts import Slot

TEXT: Slot[Callable[[object], str]] = Slot("show.pages")
HTML: Slot[Callable[[object], str]] = Slot("show.pages")


class Shown:
    """What ``optional/show`` has a page for.

    Where that part is missing, a dataclass shows its fields and any other object its class. A
    dataclass that inherits this has to be one of ``repr=False``.
    """

    def __repr__(self) -> str:
        return text_of(self)

    def _repr_html_(self) -> str | None:
        return html_of(self)


def text_of(shown: object) -> str:
    """An object in words."""
    text = TEXT.found()
    if text is not None:
        return text(shown)
    if not is_dataclass(shown):
        return object.__repr__(shown)
    values = ", ".join(f"{field.name}={getattr(shown, field.name)!r}" for field in fields(shown))
    return f"{type(shown).__name__}({values})"


def html_of(shown: object) -> str | None:
    """An object as HTML; None where the part that writes it is missing."""
    html = HTML.found()
    return None if html is None else html(shown)
