"""The fields of a kind of file, each said once: a loader, a JSON Schema and a page read the same.

A field has a kind of value, bounds, a unit, a default and a sentence. What goes beyond one field
the loader checks by hand.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np

from quasistatic_ref.text.table_reader import REQUIRED, TableReader


@dataclass(frozen=True)
class Field:
    """One field of a table in a file: kind of value, bounds, unit, default and meaning.

    Parameters
    ----------
    kind : str
        ``"number"``, ``"integer"``, ``"version"``, ``"text"``, ``"boolean"``, ``"numbers"``,
        ``"three numbers"``, ``"numbers by name"``, ``"table"``, ``"tables by name"``, ``"list of
        tables"``, ``"list of words"``, or words for another kind.
    says : str
    unit : str
    default : object
        ``REQUIRED``; or None where leaving the field out is not the same as any value.
    above, least, most : float or int, optional
        Bounds of a number [the field's unit]; `least` of a list: 1, it is not empty.
    choices : tuple, optional
    of : str
        Kind of the tables within; none: any tables.
    schema : mapping
        JSON Schema of another kind; of a kind above, what it adds.
    shape : tuple of int or str
        Of numbers: ``(4, "n_a + n_u")`` has lengths of other fields.
    null : bool
        Whether JSON's null may stand in its place.
    """

    kind: str
    says: str
    unit: str = ""
    default: Any = REQUIRED
    above: float | None = None
    least: float | None = None
    most: float | None = None
    choices: tuple[Any, ...] | None = None
    of: str = ""
    schema: Mapping[str, Any] = field(default_factory=dict)
    shape: tuple[int | str, ...] = (3,)
    null: bool = False

    def read(
        self,
        table: TableReader,
        name: str,
        default: Any = ...,
        lengths: Mapping[str, int] = MappingProxyType({}),
    ) -> Any:
        """The value in a table; `default` in place of the field's own.

        Parameters
        ----------
        table : TableReader
        name : str
        default : object
        lengths : mapping of str to int
            What `shape` has, by name.
        """
        default = self.default if default is ... else default
        if (default is None and name not in table) or (self.null and table.is_null(name)):
            return table.take(name, None)
        bounds: dict[str, Any] = {"least": self.least, "most": self.most}
        if self.kind == "number":
            return table.number(name, default, above=self.above, **bounds)
        if self.kind == "integer":
            return table.integer(name, default, **bounds, choices=self.choices)
        if self.kind == "version":
            return table.version(name, self.choices or ())
        if self.kind == "text":
            text = table.text(name, default, self.choices)
            return None if text is None else str(text)  # not a kind of str of the reader's
        if self.kind == "boolean":
            return table.boolean(name, default)
        if self.kind in ("numbers", "three numbers"):
            default = default if default is REQUIRED else np.array(default, dtype=np.float64)
            return table.array(name, tuple(_length(n, lengths) for n in self.shape), default)
        if self.kind == "numbers by name":
            inner = table.table(name, default)
            return {key: inner.number(key) for key in inner.names_left()}
        if self.kind in ("table", "tables by name"):
            return table.table(name, default)
        if not self.kind.startswith("list of "):
            return table.take(name, default)
        listed = table.words if self.kind == "list of words" else table.sequence
        items = listed(name, REQUIRED if default is None else default)
        if self.least and items == []:
            raise table.error_about(name, "must not be empty")
        return items


def head(name: str, version: int) -> dict[str, Field]:
    """The first fields of a file: its format and version."""
    return {
        "format": Field("text", "what the file is", choices=(name,)),
        "version": Field("version", "of the format", choices=(version,)),
    }


def _length(n: int | str, lengths: Mapping[str, int]) -> int:
    return n if isinstance(n, int) else sum(lengths[name] for name in n.split(" + "))


class Tables(dict[str, dict[str, Field]]):
    """The declared fields of each kind of table, by name."""

    def fields(self, table: TableReader, kind: str, **lengths: int) -> Callable[..., Any]:
        """The values in a table of some kind, as a function of the names of its fields.

        A second argument replaces the default of the field. InputError if a field is missing and
        has no default, or is not of its kind.
        """
        return lambda name, default=...: self[kind][name].read(table, name, default, lengths)

    def read(self, table: TableReader, kind: str, **lengths: int) -> dict[str, Any]:
        """The values of all fields of a table, and of the tables within.

        Whole numbers, and the numbers of entries of lists, are `lengths` of the fields after them.

        Raises
        ------
        InputError
            If a field is missing, unknown or not of its kind.
        """
        values: dict[str, Any] = {}
        for name, one in self[kind].items():
            if one.kind == "list of tables":
                inner = table.tables(name, one.default)
                value: Any = [self.read(each, one.of, **lengths) for each in inner]
            else:
                value = one.read(table, name, lengths=lengths)
            if isinstance(value, TableReader):
                value = self.read(value, one.of, **lengths)
            elif isinstance(value, int | list):
                lengths[name] = value if isinstance(value, int) else len(value)
            values[name] = value
        table.close()
        return values

    def record(self, kind: str, data: object) -> dict[str, Any]:
        """A table of the attributes of some data, and of what has one choice, in their order."""
        return {
            name: one.choices[0] if one.choices and len(one.choices) == 1 else getattr(data, name)
            for name, one in self[kind].items()
        }
