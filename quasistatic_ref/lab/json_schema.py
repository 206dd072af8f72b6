"""The table of a file's fields as a JSON Schema.

It is of draft 4, the latest that editors' TOML servers (taplo) understand.
"""

import re
from collections.abc import Mapping
from typing import Any

from quasistatic_ref.files.declared import Field, Tables
from quasistatic_ref.files.table_reader import REQUIRED
from quasistatic_ref.tolerances import LARGE

DRAFT = "http://json-schema.org/draft-04/schema#"
NUMBER = {"type": "number", "minimum": -LARGE, "maximum": LARGE}


def json_schema(
    title: str, tables: Tables, rules: Mapping[str, Mapping[str, Any]], top: str
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
    """
    every = {kind: _table(fields, rules.get(kind, {})) for kind, fields in tables.items()}
    whole = every.pop(top)
    definitions = {_key(kind): schema for kind, schema in every.items()}
    return {"$schema": DRAFT, "title": title, **whole, "definitions": definitions}


def _key(kind: str) -> str:
    return re.sub(r"\W+", "_", kind).strip("_")


def _table(fields: Mapping[str, Field], rule: Mapping[str, Any]) -> dict[str, Any]:
    required = [name for name, one in fields.items() if one.default is REQUIRED]
    schema: dict[str, Any] = {
        "type": "object",
        "properties": {name: _field(one) for name, one in fields.items()},
        "additionalProperties": False,
        **({"required": required} if required else {}),
    }
    return schema | dict(rule)


def _field(one: Field) -> dict[str, Any]:
    plain = one.default is not REQUIRED and one.default is not None
    schema: dict[str, Any] = {"description": one.says + (f" [{one.unit}]" if one.unit else "")}
    if plain:
        schema["default"] = one.default
    schema |= _value(one)
    for key, more in one.schema.items():
        both = isinstance(more, dict) and isinstance(schema.get(key), dict)
        schema[key] = schema[key] | more if both else more
    return schema


def _value(one: Field) -> dict[str, Any]:
    """The schema of a kind of value; nothing for a kind that brings its own."""
    inner = {"$ref": f"#/definitions/{_key(one.of)}"} if one.of else {"type": "object"}
    kinds: dict[str, dict[str, Any]] = {
        "number": NUMBER,
        "integer": NUMBER | {"type": "integer"},
        "text": {"type": "string"},
        "boolean": {"type": "boolean"},
        "three numbers": {"type": "array", "items": NUMBER, "minItems": 3, "maxItems": 3},
        "list of words": {"type": "array", "items": {"type": "string"}},
        "table": {"allOf": [inner]},
        "tables by name": {"type": "object", "additionalProperties": inner},
        "list of tables": {"type": "array", "items": inner},
    }
    schema = dict(kinds.get(one.kind, {}))
    if one.above is not None:
        schema |= {"minimum": one.above, "exclusiveMinimum": True}
    if one.least is not None:
        schema["minItems" if one.kind.startswith("list of ") else "minimum"] = one.least
    if one.most is not None:
        schema["maximum"] = one.most
    if one.choices is not None:
        schema["enum"] = list(one.choices)
    return schema
