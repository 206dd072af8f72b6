"""Overrides of a scenario's tables before they are read: ``--set`` of a command, or from Python."""

import itertools
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from operator import eq
from os import PathLike, fspath
from typing import Any

from quasistatic_ref.errors import InputError, ScenarioError
from quasistatic_ref.files.option_change import OptionChange
from quasistatic_ref.text.content import LONG_KEY, MOST_PARTS
from quasistatic_ref.text.json_text import plain
from quasistatic_ref.text.table_reader import TableReader

Changes = Sequence[str] | Mapping[str, Any]

SET = "--set"
ESSENTIAL = {"bodies": "urdf", "contacts": "alpha"}
"""Tables of tables, and a field without which none of theirs can be."""


class Origins:
    """Who said what stands in a scenario's tables: its author, or a change of the user.

    Parameters
    ----------
    of_user : bool
        Whether the tables themselves are the user's own, and not a stranger's as in a file.

    Attributes
    ----------
    changes : list of (tuple of str, str)
        Of each change in its order, the keys that lead to its value, and its text as the user
        wrote it; empty of a value from Python.
    """

    def __init__(self, of_user: bool) -> None:
        self.of_user = of_user
        self.changes: list[tuple[tuple[str, ...], str]] = []

    def is_of_user(self, keys: tuple[str, ...]) -> bool:
        """Whether the value to which keys lead is the user's own."""
        return self.of_user or any(keys[: len(path)] == path for path, _ in self.changes)

    def reader(self, tables: dict[str, Any]) -> TableReader:
        """A reader of the tables, which knows what is the user's own."""
        return TableReader(tables, error=ScenarioError, of_user=self.is_of_user)

    def change(self, field: str) -> str | None:
        """The last change that wrote a field, as its user wrote it; None if no change did.

        In Python it is the field itself.
        """
        change: str | None = None
        for path, words in self.changes:
            key = ".".join(path)
            inner = field.removeprefix(key)
            if field.startswith(key) and inner[:1] in ("", ".", "["):
                change = f"{words}: {inner.lstrip('.')}" if words and inner else words or field
        return change


@contextmanager
def about_changes(origins: Origins) -> Iterator[None]:
    """Make an InputError of this block name the change that wrote the value, if one did."""
    try:
        yield
    except InputError as error:
        if error.file is None and error.field == SET:
            error.change = f"{SET} {error.value}"
        elif error.file is None and error.field is not None:
            error.change = origins.change(error.field)
        raise


def apply_settings(
    tables: dict[str, Any], settings: Changes, named: Mapping[str, Any], origins: Origins
) -> dict[tuple[str, str], str]:
    """Apply the user's changes to a scenario's tables, in place.

    Parameters
    ----------
    tables : dict
    settings : sequence of str, or mapping of str to object
        ``dotted.key=value``, the value being TOML or else a plain word; or values by dotted key.
    named : mapping of str to object
        Values by the names of fields at the top, made next; or by dotted keys, made last.
    origins : Origins
        To which the changes are added.

    Returns
    -------
    dict of (str, str) to str
        The dotted key by ``("contacts", "grp")`` for each table of ``[contacts]`` that a dotted
        key has made, and so for the other tables at the top.

    Raises
    ------
    ScenarioError
        If a key is none, or leads to no table; or a value is nested without end.
    """
    before = _second_level(tables)
    if not _are_several(settings):
        problem = "must be a list of dotted.key=value, or a mapping of dotted keys to values"
        raise ScenarioError(problem, field="settings", value=settings)
    keys = [*filter(_is_dotted, named)]
    if isinstance(settings, Mapping):
        keys += map(str, settings)
        for key, value in settings.items():
            origins.changes.append((_parts(str(key)), ""))
            _put(tables, str(key), own_value(key, value), "settings", key)
    else:
        for setting in settings:
            key, equals, text = str(setting).partition("=")
            keys.append(key.strip())
            words = setting.option if isinstance(setting, OptionChange) else f"{SET} {setting}"
            origins.changes.append((_parts(key), words))
            _put(tables, key if equals else "", parsed(text), SET, setting)
    made = _second_level(tables) - before
    for key in itertools.filterfalse(_is_dotted, named):
        origins.changes.append(((key,), ""))
        value = own_value(key, named[key])
        _check_whole(key, tables.get(key), value)
        tables[key] = value
    before = _second_level(tables)
    for key in filter(_is_dotted, named):
        origins.changes.append((_parts(key), ""))
        _put(tables, key, own_value(key, named[key]), "settings", key)
    made |= _second_level(tables) - before
    return {pair: _leading_to(pair, keys) for pair in made & _second_level(tables)}


def _parts(key: str) -> tuple[str, ...]:
    return tuple(part.strip() for part in key.split("."))


def _leading_to(pair: tuple[str, str], keys: Iterable[str]) -> str:
    """The first dotted key that leads to a table, or to the table that holds it."""
    return next(key for key in keys if all(map(eq, _parts(key), pair)))


def _are_several(settings: object) -> bool:
    return isinstance(settings, Iterable) and not isinstance(settings, str)


def _is_dotted(key: str) -> bool:
    return "." in key


def _check_whole(kind: str, before: Any, after: Any) -> None:
    """Refuse a table that would replace one of the file, and is only a part of it."""
    if kind not in ESSENTIAL or not (isinstance(before, dict) and isinstance(after, dict)):
        return
    for name, table in after.items():
        if name in before and isinstance(table, dict) and table and ESSENTIAL[kind] not in table:
            problem = (
                f"would replace the whole table; a single field is the setting "
                f'"{kind}.{name}.{next(iter(table))}"'
            )
            raise ScenarioError(problem, field=f"{kind}.{name}", value=table)


def _second_level(tables: Mapping[str, Any]) -> set[tuple[str, str]]:
    pairs = ((key, inner) for key, inner in tables.items() if isinstance(inner, dict))
    return {(key, name) for key, inner in pairs for name in inner if isinstance(inner[name], dict)}


def _put(tables: dict[str, Any], key: str, value: Any, field: str, source: object) -> None:
    parts = _parts(key)
    if not all(parts):
        problem = "must be table.field=value, such as contacts.floor.mu_v=0.5"
        raise ScenarioError(problem, field=field, value=source)
    if len(parts) > MOST_PARTS:
        problem = f"is a key of {len(parts)} parts; a scenario has none of more than {MOST_PARTS}"
        raise ScenarioError(problem, field=field, value=source)
    table: Any = tables
    for part in parts[:-1]:
        table = table.setdefault(part, {}) if isinstance(table, dict) else None
    if not isinstance(table, dict):
        raise ScenarioError("is not a table", field=field, value=source)
    table[parts[-1]] = value


def parsed(text: str) -> Any:
    """The value of a setting that is given as text: TOML, or else a plain word.

    What has a key of more than `MOST_PARTS` parts is a word, too.
    """
    try:
        tables = {} if LONG_KEY.search(text) else tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        tables = {}
    # Anything but one value, such as a second line, is taken as a word.
    return tables["value"] if list(tables) == ["value"] else text.strip()


def own_value(field: object, value: Any) -> Any:
    """A Python value in the form in which a TOML parser would return it.

    Raises
    ------
    ScenarioError
        If it holds itself, or is nested too deeply.
    """
    try:
        return _as_parsed(plain(value))
    except RecursionError:
        raise ScenarioError("is nested too deeply, or holds itself", field=str(field)) from None


def _as_parsed(value: Any) -> Any:
    if isinstance(value, PathLike):
        return fspath(value)
    if isinstance(value, Mapping):
        return {str(key): _as_parsed(inner) for key, inner in value.items()}
    return [_as_parsed(inner) for inner in value] if isinstance(value, list) else value
