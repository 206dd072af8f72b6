"""Walks over cases and outputs: lists and tables that are nested in one another."""

from collections.abc import Callable, Collection, Iterator
from typing import Any

Json = Any
"""What JSON holds: None, bool, int, float, str, lists and string-keyed dicts of them."""
Path = tuple[str | int, ...]
"""Keys and indices that lead to a part."""


def nodes(value: Json, path: Path = ()) -> Iterator[tuple[Path, Json]]:
    """Every part of a JSON value with its path; a whole comes before its parts."""
    yield path, value
    inside = enumerate(value) if isinstance(value, list) else ()
    for key, inner in value.items() if isinstance(value, dict) else inside:
        yield from nodes(inner, (*path, key))


def mapped(value: Json, leaf: Callable[[Json], Json], kept: Collection[str] = ()) -> Json:
    """The JSON value with every leaf replaced, except in the fields `kept`."""
    if isinstance(value, dict):
        return {key: v if key in kept else mapped(v, leaf, kept) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [mapped(v, leaf, kept) for v in value]
    return leaf(value)
