"""Reading the named fields of a JSON object or a TOML table, with plain errors.

A reader takes each field once, checks it, and refuses in :meth:`TableReader.close` whatever was
not taken: a misspelt name is an error, never a default.
"""

from collections.abc import Callable, Iterable, Iterator
from typing import Any, Final

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.quoting import suggestion

REQUIRED: Final[Any] = object()


class TableReader:
    """Reads the fields of one table, each once.

    Parameters
    ----------
    table : object
        What the parser returned; anything but a mapping is refused.
    where : str
        Dotted name of the table itself, ``""`` at the top.
    error : type
        The :class:`~quasistatic_ref.errors.InputError` to raise.
    keys : tuple of str
        The keys that lead to the table: a name may hold dots itself.
    of_user : callable, optional
        Of the keys that lead to a value: whether it is the user's own, and no file's.

    Attributes
    ----------
    fields : dict
        The table as it was parsed.
    """

    def __init__(
        self,
        table: object,
        where: str = "",
        error: type[InputError] = InputError,
        keys: tuple[str, ...] = (),
        of_user: Callable[[tuple[str, ...]], bool] = lambda _: False,
    ) -> None:
        self.where = where
        self.error = error
        self.keys = keys
        self._of_user = of_user
        if not isinstance(table, dict):
            raise error("must be a table of named fields", field=where or None, value=table)
        self.fields: dict[str, Any] = table
        self._left: dict[str, Any] = dict(table)
        self._known: set[str] = set()

    def name(self, field: str) -> str:
        """The full dotted name of a field."""
        return f"{self.where}.{field}" if self.where else field

    def is_of_user(self, field: str) -> bool:
        """Whether what a field holds is the user's own, and no file's."""
        return self._of_user((*self.keys, field))

    def error_about(self, field: str, problem: str, value: object = None) -> InputError:
        """The error about one field, for the caller to raise."""
        return self.error(problem, field=self.name(field), value=value)

    def take(self, field: str, default: Any = REQUIRED) -> Any:
        """A field as parsed; a missing one is the default, or an error."""
        self._known.add(field)
        if field in self._left:
            return self._left.pop(field)
        if default is REQUIRED:
            raise self.error_about(field, "is missing; add it")
        return default

    def __contains__(self, field: str) -> bool:
        return field in self._left

    def peek(self, field: str) -> Any:
        """A field as parsed, which stays to be taken; None if it is not there."""
        return self._left.get(field)

    def is_null(self, field: str) -> bool:
        """Whether a field is there and holds JSON's null."""
        return field in self._left and self._left[field] is None

    def names_left(self) -> list[str]:
        """The names of the fields that are not yet taken, in file order."""
        return list(self._left)

    def _typed(self, field: str, kind: Any, words: str, default: Any) -> Any:
        """A field of one kind, of which booleans are no numbers; None if that is default."""
        value = self.take(field, default)
        fits = isinstance(value, kind) and (kind is bool or not isinstance(value, bool))
        if not fits and (value is not None or default is not None):
            raise self.error_about(field, f"must be {words}", value)
        return value

    def number(
        self,
        field: str,
        default: Any = REQUIRED,
        *,
        above: float | None = None,
        least: float | None = None,
        most: float | None = None,
    ) -> float:
        """A finite number, above `above`, from `least` to `most` [the field's unit]."""
        value = self._typed(field, int | float, "a number", default)
        if value is None:
            return None  # type: ignore[return-value]  # only where the caller's default is None
        try:
            number = float(value)
        except OverflowError:
            number = float("inf")
        if not np.isfinite(number):
            raise self.error_about(field, "must be a finite number", value)
        if above is not None and not number > above:
            raise self.error_about(field, f"must be greater than {above:g}", value)
        self._check_bounds(field, value, least, most)
        return number

    def integer(
        self,
        field: str,
        default: Any = REQUIRED,
        *,
        least: int | None = None,
        most: int | None = None,
        choices: tuple[int, ...] | None = None,
    ) -> int:
        """A whole number, at least `least` and at most `most`, or one of `choices`."""
        value: int = self._typed(field, int, "a whole number", default)
        if value is None:
            return value
        if choices is not None and value not in choices:
            raise self.error_about(field, f"must be {' or '.join(map(str, choices))}", value)
        self._check_bounds(field, value, least, most)
        return value

    def _check_bounds(
        self, field: str, value: float, least: float | None, most: float | None
    ) -> None:
        if least is not None and value < least:
            raise self.error_about(field, f"must be at least {least:.9g}", value)
        if most is not None and value > most:
            raise self.error_about(field, f"must be at most {most:.9g}", value)

    def boolean(self, field: str, default: Any = REQUIRED) -> bool:
        """A field that is true or false."""
        value: bool = self._typed(field, bool, "true or false", default)
        return value

    def text(
        self, field: str, default: Any = REQUIRED, choices: tuple[str, ...] | None = None
    ) -> str:
        """A field that is a string, one of `choices` where they are given."""
        value: str = self._typed(field, str, "a string", default)
        if value is not None and choices is not None and value not in choices:
            problem = f"is not a choice{suggestion(value, choices)}"
            if len(choices) == 1:  # the format of a file, which is then of another kind
                problem = f"must be {choices[0]!r}"
            raise self.error_about(field, problem, value)
        return value

    def array(
        self, field: str, shape: tuple[int, ...], default: Any = REQUIRED, *, infinite: bool = False
    ) -> np.ndarray:
        """A field that is finite numbers of a shape, or also `infinite` ones, as float64."""
        value = self.take(field, default)
        count = " x ".join(map(str, shape))
        problem = f"must be {count} numbers"
        if isinstance(value, str):
            problem += ", with commas between them and brackets around them"
            raise self.error_about(field, problem, value)
        try:
            entries = np.array(value, dtype=object)
            kinds = {type(entry) for entry in entries.flat}
            fit = all(issubclass(kind, int | float) and kind is not bool for kind in kinds)
            numbers = entries.astype(np.float64) if fit else None
        except (ValueError, OverflowError, TypeError, RuntimeError):  # 33 axes and more
            numbers = None
        if numbers is None:
            problem = f"must be {count} finite numbers"
            if len(shape) > 1:
                problem += ", in lists of equal length"
            raise self.error_about(field, problem, value)
        if numbers.shape == (0,) and 0 in shape:
            numbers = numbers.reshape(shape)
        if numbers.shape != shape:
            raise self.error_about(field, problem, value)
        if not np.isfinite(numbers).all() and (not infinite or np.isnan(numbers).any()):
            raise self.error_about(field, "must contain finite numbers only", value)
        return numbers

    def sequence(self, field: str, default: Any = REQUIRED) -> list[Any]:
        """A field that is a list."""
        value: list[Any] = self._typed(field, list, "a list", default)
        return value

    def words(self, field: str, default: Any = REQUIRED) -> list[str]:
        """A field that is a list of strings."""
        value = self.sequence(field, default)
        if value is not default and not all(isinstance(word, str) for word in value):
            raise self.error_about(field, "must be a list of strings", value)
        return value

    def table(self, field: str, default: Any = REQUIRED) -> "TableReader":
        """The reader of a field that is a table."""
        table = self.take(field, default)
        return TableReader(table, self.name(field), self.error, (*self.keys, field), self._of_user)

    def tables(self, field: str, default: Any = REQUIRED) -> Iterator["TableReader"]:
        """The readers of a field that is a list of tables, one after the other."""
        for i, table in enumerate(self.sequence(field, default)):
            yield TableReader(table, f"{self.name(field)}[{i}]", self.error)

    def check_format(self, name: str, *versions: int) -> int:
        """Take ``format`` and ``version`` of a file, refuse others than these: the version."""
        self.text("format", choices=(name,))
        return self.version("version", versions)

    def version(self, field: str, versions: tuple[int, ...]) -> int:
        """The version of a format, one of those that this program reads."""
        version = self.integer(field)
        if version not in versions:
            known = " and ".join(map(str, versions))
            problem = f"is not known here; this program reads {known}"
            raise self.error_about(field, problem, version)
        return version

    def only(self, known: Iterable[str]) -> None:
        """Refuse every field but these: before any of them is found missing."""
        self._known.update(known)
        for field, value in self._left.items():
            if field not in self._known:
                raise self.error_about(field, f"is unknown{suggestion(field, self._known)}", value)

    def close(self) -> None:
        """Refuse every field that was not taken."""
        self.only(())
