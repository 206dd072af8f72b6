"""Records of JSON and TOML: their places, other values there, TOML as text, headers of files."""

import copy
import json

import numpy as np


def places(value, above=()):
    """Where a value can be replaced in a record."""
    if above:
        yield above
    if isinstance(value, dict | list):
        inner = value.items() if isinstance(value, dict) else enumerate(value)
        for key, one in inner:
            yield from places(one, (*above, key))


def value_at(record, place):
    """The value at a place of a record."""
    for key in place:
        record = record[key]
    return record


def with_value(record, place, value):
    """A copy of a record with something else at a place, or nothing there, by `...`."""
    if not place:
        return value
    new = copy.deepcopy(record)
    owner = value_at(new, place[:-1])
    if value is ...:
        del owner[place[-1]]
    else:
        owner[place[-1]] = value
    return new


def toml_text(record):
    """A record as inline TOML."""
    return "".join(f"{json.dumps(k)} = {_toml(v)}\n" for k, v in record.items()).encode()


def _toml(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {_toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return repr(value) if isinstance(value, float) else json.dumps(value)


def header_in(path):
    """The header of a trajectory's file."""
    with np.load(path) as file:
        return json.loads(file["header"].tobytes())


def change_header(path, **changes):
    """Some fields of the header of a trajectory's file become others, or leave by `...`."""
    with np.load(path) as file:
        arrays = dict(file)
    header = {k: v for k, v in (header_in(path) | changes).items() if v is not ...}
    arrays["header"] = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    np.savez(path, **arrays)
