"""The table of a scenario's fields as a JSON Schema.

It is of draft 4, the latest that editors' TOML servers (taplo) understand.
"""

import re
from typing import Any

from quasistatic_ref.fields import REQUIRED
from quasistatic_ref.simulate.scenario_table import RULES, TABLES, TOP, Field
from quasistatic_ref.tolerances import LARGE

DRAFT = "http://json-schema.org/draft-04/schema#"
NUMBER = {"type": "number", "minimum": -LARGE, "maximum": LARGE}


def scenario_schema() -> dict[str, Any]:
    """The JSON Schema of a scenario file."""
    definitions = {_key(kind): _table(kind) for kind in TABLES if kind != TOP}
    return {"$schema": DRAFT, "title": "A scenario", **_table(TOP), "definitions": definitions}


def _key(kind: str) -> str:
    return re.sub(r"\W+", "_", kind).strip("_")


def _table(kind: str) -> dict[str, Any]:
    fields = TABLES[kind]
    required = [name for name, one in fields.items() if one.default is REQUIRED]
    schema: dict[str, Any] = {
        "type": "object",
        "properties": {name: _field(one) for name, one in fields.items()},
        "additionalProperties": False,
        **({"required": required} if required else {}),
    }
    return schema | dict(RULES.get(kind, {}))


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
    inner = {"$ref": f"#/definitions/{_key(one.of)}"}
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
        schema["minimum"] = one.least
    if one.most is not None:
        schema["maximum"] = one.most
    if one.choices is not None:
        schema["enum"] = list(one.choices)
    return schema
