"""Pages of objects, in words and in HTML."""

from __future__ import annotations

from quasistatic_ref.parts import is_there


def page_text(shown: object) -> str | None:
    """The page of an object in words."""
    if not is_there("show"):
        return None
    from quasistatic_ref.optional.show.pages import text

    return text(shown)


def page_html(shown: object) -> str | None:
    """The page of an object as an HTML element."""
    if not is_there("show"):
        return None
    from quasistatic_ref.optional.show.pages import html

    return html(shown)
