"""Fields that are formed when somebody asks for them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


class Lazy:
    """What a frozen dataclass inherits to have fields made later.

    Such a field is not set; ``__dict__["later"]`` holds the functions that make them, by name.
    """

    def __getattr__(self, name: str) -> Any:
        later: dict[str, Callable[[], Any]] = self.__dict__.get("later", {})
        if name not in later:
            kind = type(self).__name__
            raise AttributeError(f"{kind!r} object has no attribute {name!r}")
        self.__dict__[name] = value = later[name]()
        return value
