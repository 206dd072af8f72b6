"""The fields of a kind of file, each said once: a loader, a JSON Schema and a page read the same.

A field has a kind of value, bounds, a unit, a default and a sentence. What goes beyond one field
the loader checks by hand.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from quasistatic_ref.files.table_reader import REQUIRED, TableReader


@dataclass(frozen=True)
class Field:
    """One field of a table in a file: kind of value, bounds, unit, default and meaning.

    Parameters
    ----------
    kind : str
        ``"number"``, ``"integer"``, ``"text"``, ``"boolean"``, ``"three numbers"``, ``"table"``,
        ``"tables by name"``, ``"list of tables"``, ``"list of words"``, or words for another kind.
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

    def read(self, table: TableReader, name: str, default: Any = ...) -> Any:
        """The value in a table; `default` in place of the field's own."""
        default = self.default if default is ... else default
        bounds: dict[str, Any] = {"least": self.least, "most": self.most}
        if self.kind == "number":
            return table.number(name, default, above=self.above, **bounds)
        if self.kind == "integer":
            return table.integer(name, default, **bounds, choices=self.choices)
        if self.kind == "text":
            text = table.text(name, default, self.choices)
            return None if text is None else str(text)  # not a kind of str of the reader's
        if self.kind == "boolean":
            return table.boolean(name, default)
        if self.kind == "three numbers":
            default = default if default is REQUIRED else np.array(default, dtype=np.float64)
            return table.array(name, (3,), default)
        if self.kind in ("table", "tables by name"):
            return table.table(name, default)
        if not self.kind.startswith("list of "):
            return table.take(name, default)
        listed = table.words if self.kind == "list of words" else table.sequence
        items = listed(name, default)
        if self.least and items == []:
            raise table.error_about(name, "must not be empty")
        return items


class Tables(dict[str, dict[str, Field]]):
    """The declared fields of each kind of table, by name."""

    def fields(self, table: TableReader, kind: str) -> Callable[..., Any]:
        """The values in a table of some kind, as a function of the names of its fields.

        A second argument replaces the default of the field. InputError if a field is missing and
        has no default, or is not of its kind.
        """
        return lambda name, default=...: self[kind][name].read(table, name, default)
