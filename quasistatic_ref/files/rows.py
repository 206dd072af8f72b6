"""Rows of a table in a text: their words, which one separator parts."""

import csv
import re

from quasistatic_ref.errors import InputError

BLANKS = " "
"""Stands for any spaces and tabs between two words."""
SEPARATORS = {";": "semicolons", ",": "commas", BLANKS: "spaces or tabs"}
QUOTED = re.compile('"[^"]*"')
WORD = re.compile(r'"[^"]*"|\S+')
NAME = re.compile(r'"[^"]*"|[^\s"\[(]+(?:\s*(?:\[[^\[\]]*\]|\([^()]*\)))?')
"""A name between blanks, with its unit in brackets."""
DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?", re.ASCII)


def separator_of(row: str) -> str:
    """What parts the words of a row: one of SEPARATORS."""
    bare = QUOTED.sub("", row)
    words = bare.split()
    if len(words) > 1 and all(map(DECIMAL_COMMA.fullmatch, words)):
        return BLANKS
    return next((mark for mark in ";," if mark in bare), BLANKS)


def words_of(row: str, separator: str) -> list[str]:
    """The words of a row, without the quotes around them."""
    if separator == BLANKS:
        return [word.strip('"').strip() for word in WORD.findall(row)]
    (words,) = csv.reader([row], delimiter=separator, skipinitialspace=True)
    return [word.strip() for word in words]


def names_of(row: str, separator: str) -> list[str]:
    """The names in the first row of a table; tabs, where it has them, part names with blanks."""
    if separator != BLANKS:
        return words_of(row, separator)
    names = re.split(r"\t+", row) if "\t" in row else NAME.findall(row)
    return [name.strip().strip('"').strip() for name in names]


def check_separator(row: str, separator: str, error: type[InputError]) -> None:
    """Refuse a row whose words other marks part than those of the rows above it."""
    if separator_of(row) != separator:
        problem = f"must be separated by {SEPARATORS[separator]}, as the rows above it"
        raise error(problem, value=row)


def check_decimal_point(word: str, error: type[InputError]) -> None:
    """Refuse a number that is written with a decimal comma."""
    if DECIMAL_COMMA.fullmatch(word):
        raise error("has a decimal comma; write decimals with a point", value=word)
