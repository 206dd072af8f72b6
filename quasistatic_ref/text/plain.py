"""Plain data: fields that are compared bit for bit, copied and pickled."""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Mapping
from dataclasses import Field, fields
from functools import cache
from typing import Any, ClassVar, Self

import numpy as np


class Plain:
    """A base of frozen dataclasses: compared bit by bit, copied and pickled by their fields.

    Two objects are equal if they are of one class and their fields hold the same bits. NaN is then
    NaN, and -0.0 is 0.0, as which it is written everywhere. Fields of ``compare=False``, such as
    wall times, do not count. The hash is one of the content. A copy, also one through a pickle, has
    the fields as they were: nothing is computed, and an array that could not be written still
    cannot.
    """

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Plain):
            return NotImplemented
        return bool(bits(self) == bits(other))

    def same_as(self, other: Plain) -> bool:
        """Whether two objects have the same class and the same bits in all fields.

        It says no of -0.0 and 0.0, which are equal, and of two that keep their fields otherwise.
        """
        if type(self) is not type(other):
            return False
        return self is other or all(
            _same(getattr(self, name), getattr(other, name)) for name in self.kept()
        )

    @classmethod
    def compared_as(cls) -> Any:
        """The class that comparisons use: a subclass with late fields counts as its parent."""
        return cls

    @classmethod
    @cache
    def kept(cls) -> tuple[str, ...]:
        """Names of the fields that copies and pickles keep."""
        return tuple(field.name for field in fields(cls))

    @classmethod
    def unchecked(cls, **fields: Any) -> Self:
        """An object made of valid fields, without running the checks."""
        made = cls.__new__(cls)
        made.__dict__.update(fields)
        return made

    def with_fields(self, **changes: Any) -> Self:
        """A copy with some valid fields replaced, without running the checks."""
        copy: Self = self.compared_as().unchecked(**(field_values(self) | changes))
        return copy

    def __hash__(self) -> int:
        return hash(bits(self))

    def __getstate__(self) -> tuple[dict[str, Any], list[str]]:
        values = {name: getattr(self, name) for name in self.kept()}
        arrays = {name: a for name, a in values.items() if isinstance(a, np.ndarray)}
        return values, [name for name, array in arrays.items() if not array.flags.writeable]

    def __setstate__(self, state: tuple[dict[str, Any], list[str]]) -> None:
        values, locked = state
        self.__dict__.update(values)
        for name in locked:
            values[name].setflags(write=False)


class LazyFields(Plain):
    """Plain data of which some fields are computed when they are read.

    A class inherits it before the class whose data it forms.

    Attributes
    ----------
    formed, kept_instead : tuple of str
        Their names, and what is kept in their place.
    """

    formed: ClassVar[tuple[str, ...]]
    kept_instead: ClassVar[tuple[str, ...]]

    def __new__(cls, *_: object, **fields: Any) -> Any:
        """An object of the plain parent class if all fields are given, as by ``replace``."""
        return cls.compared_as()(**fields) if fields else super().__new__(cls)

    @classmethod
    def compared_as(cls) -> type:
        """The class whose fields this one computes late."""
        return cls.__bases__[1]

    @classmethod
    @cache
    def kept(cls) -> tuple[str, ...]:
        """Names of the parent's fields, without those that are computed late."""
        every = (name for name in super().kept() if name not in cls.formed)
        return *every, *cls.kept_instead


def _same(one: Any, other: Any) -> bool:
    if one is other:
        return True
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        return one.shape == other.shape and one.tobytes() == other.tobytes()
    if isinstance(one, Plain) and isinstance(other, Plain):
        return one.same_as(other)
    return type(one) is type(other) and bits(one) == bits(other)


def field_values(data: Plain) -> dict[str, Any]:
    """All fields of plain data by name."""
    return {f.name: getattr(data, f.name) for f in fields(data)}


def bits(value: Any) -> Any:
    """An object that equals that of another value only if types and bits are the same.

    Parameters
    ----------
    value : object
        A number, array or text; a tuple, list or mapping of such; plain data; or anything that
        compares itself.
    """
    if isinstance(value, str | int):
        return type(value), value
    if isinstance(value, Plain):
        compared = [f.name for f in fields(value) if f.compare]
        return type(value).compared_as(), tuple(bits(getattr(value, name)) for name in compared)
    if isinstance(value, np.ndarray):
        numbers = value + 0.0 if value.dtype.kind == "f" else value
        return value.dtype.str, value.shape, numbers.tobytes()
    if isinstance(value, float):
        return type(value), struct.pack("d", value + 0.0)
    if isinstance(value, tuple | list):
        return type(value), tuple(map(bits, value))
    if isinstance(value, Mapping):
        return type(value), frozenset((key, bits(value[key])) for key in value)
    if isinstance(value, slice):
        return slice, value.start, value.stop, value.step
    return type(value), value


def fingerprint(value: object) -> str:
    """SHA-256 of what :func:`bits` compares, in hexadecimal: the same in every process."""
    return hashlib.sha256(repr(_in_order(bits(value))).encode()).hexdigest()


def _in_order(value: Any) -> Any:
    """Nested bits, of which mappings are in the order of their text."""
    if isinstance(value, tuple):
        return tuple(map(_in_order, value))
    return sorted(map(repr, map(_in_order, value))) if isinstance(value, frozenset) else value
