"""Objects that show themselves: in words where they are printed, as HTML in a notebook."""

from collections.abc import Callable
from dataclasses import fields
from typing import Any

import numpy as np

from quasistatic_ref.formats.quoting import shown_value
from quasistatic_ref.parts import Slot

TEXT: Slot[Callable[[object], str]] = Slot("show.pages")
HTML: Slot[Callable[[object], str]] = Slot("show.pages")


class Shown:
    """A dataclass of ``repr=False`` that shows its fields on one line, arrays by their shapes."""

    def __repr__(self) -> str:
        data: Any = self
        values = [
            f"{one.name}={_short(getattr(self, one.name))}" for one in fields(data) if one.repr
        ]
        return f"{type(self).__name__}({', '.join(values)})"


class HasPage(Shown):
    """What ``optional/show`` has a page for; where that part is missing, its fields are shown."""

    def __repr__(self) -> str:
        text = TEXT.found()
        return super().__repr__() if text is None else text(self)

    def _repr_html_(self) -> str | None:
        html = HTML.found()
        return None if html is None else html(self)


def _short(value: object) -> str:
    return f"array{value.shape}" if isinstance(value, np.ndarray) else shown_value(value)
