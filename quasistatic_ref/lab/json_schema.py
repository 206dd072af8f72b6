"""The table of a file's fields as a JSON Schema.

It is of draft 4, the latest that editors' TOML servers (taplo) understand.
"""

import re
from collections.abc import Mapping
from typing import Any

from quasistatic_ref.text.declared import Field, Tables
from quasistatic_ref.text.table_reader import REQUIRED
from quasistatic_ref.tolerances import LARGE

DRAFT = "http://json-schema.org/draft-04/schema#"
NUMBER = {"type": "number"}
BOUNDED = NUMBER | {"minimum": -LARGE, "maximum": LARGE}
"""A number of a scenario."""


def json_schema(
    title: str,
    tables: Tables,
    rules: Mapping[str, Mapping[str, Any]],
    top: str,
    number: Mapping[str, Any] = NUMBER,
) -> dict[str, Any]:
    """The JSON Schema of a file.

    Parameters
    ----------
    title : str
        Of the schema.
    tables : Tables
    rules : mapping
        JSON Schema that a kind of table has in addition to its fields.
    top : str
        The kind of the table that a whole file is.
    number : mapping
        The JSON Schema of a number.
    """
    every = {kind: _table(fields, rules.get(kind, {}), number) for kind, fields in tables.items()}
    whole = every.pop(top)
    definitions = {_key(kind): schema for kind, schema in every.items()}
    return {"$schema": DRAFT, "title": title, **whole, "definitions": definitions}


def _key(kind: str) -> str:
    return re.sub(r"\W+", "_", kind).strip("_")


def _table(
    fields: Mapping[str, Field], rule: Mapping[str, Any], number: Mapping[str, Any]
) -> dict[str, Any]:
    required = [name for name, one in fields.items() if one.default is REQUIRED]
    schema: dict[str, Any] = {
        "type": "object",
        "properties": {name: _field(one, number) for name, one in fields.items()},
        "additionalProperties": False,
        **({"required": required} if required else {}),
    }
    return schema | dict(rule)


def _field(one: Field, number: Mapping[str, Any]) -> dict[str, Any]:
    plain = one.default is not REQUIRED and one.default is not None
    schema: dict[str, Any] = {"description": one.says + (f" [{one.unit}]" if one.unit else "")}
    if plain:
        schema["default"] = one.default
    schema |= _value(one, number)
    if one.null:
        schema["type"] = [schema["type"], "null"]
    for key, more in one.schema.items():
        both = isinstance(more, dict) and isinstance(schema.get(key), dict)
        schema[key] = schema[key] | more if both else more
    return schema


def _value(one: Field, number: Mapping[str, Any]) -> dict[str, Any]:
    """The schema of a kind of value; nothing for a kind that brings its own."""
    inner = {"$ref": f"#/definitions/{_key(one.of)}"} if one.of else {"type": "object"}
    numbers = dict(number)
    for length in reversed(one.shape):
        fixed = {"minItems": length, "maxItems": length} if isinstance(length, int) else {}
        numbers = {"type": "array", "items": numbers, **fixed}
    kinds: dict[str, Mapping[str, Any]] = {
        "number": number,
        "integer": {**number, "type": "integer"},
        "version": {**number, "type": "integer"},
        "text": {"type": "string"},
        "boolean": {"type": "boolean"},
        "numbers": numbers,
        "three numbers": numbers,
        "numbers by name": {"type": "object", "additionalProperties": number},
        "table": {"allOf": [inner]},
        "tables by name": {"type": "object", "additionalProperties": inner},
        "list of tables": {"type": "array", "items": inner},
        "list of words": {"type": "array", "items": {"type": "string"}},
    }
    listed = {"type": "array"} if one.kind.startswith("list of ") else {}
    schema = dict(kinds.get(one.kind, listed))
    if one.above is not None:
        schema |= {"minimum": one.above, "exclusiveMinimum": True}
    if one.least is not None:
        schema["minItems" if one.kind.startswith("list of ") else "minimum"] = one.least
    if one.most is not None:
        schema["maximum"] = one.most
    if one.choices is not None:
        schema["enum"] = list(one.choices)
    return schema
