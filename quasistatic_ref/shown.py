"""Objects that show themselves: in words where they are printed, as HTML in a notebook."""

from collections.abc import Callable
from dataclasses import fields
from typing import Any

import numpy as np

from quasistatic_ref.parts import is_there, part
from quasistatic_ref.quoting import shown_value

Page = Callable[[object], str | None]
"""An object -> its page, in words or as an HTML element; None if it has none."""


class Shown:
    """A dataclass of ``repr=False`` that shows its fields on one line, arrays by their shapes."""

    def __repr__(self) -> str:
        data: Any = self
        values = [
            f"{one.name}={_short(getattr(self, one.name))}" for one in fields(data) if one.repr
        ]
        return f"{type(self).__name__}({', '.join(values)})"


class HasPage(Shown):
    """Objects that ``optional/show`` prints as a page; without that part, field by field."""

    def __repr__(self) -> str:
        if not is_there("page_text"):
            return super().__repr__()
        page_text: Page = part("page_text")
        page = page_text(self)
        return super().__repr__() if page is None else page

    def _repr_html_(self) -> str | None:
        if not is_there("page_html"):
            return None
        page_html: Page = part("page_html")
        return page_html(self)


def _short(value: object) -> str:
    return f"array{value.shape}" if isinstance(value, np.ndarray) else shown_value(value)
