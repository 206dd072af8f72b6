"""Records of JSON and TOML made wrong by their values, and written as text."""

import copy
import json

import numpy as np

NUMBERS = (
    "nan", "inf", "-inf", "1e308", "-1e308", "1e999", "5e-324", "1e-323", "1e-160", "1e160",
    "-0.0", "0", "1", "-1", "1e15", "1e16", "0.1", "2147483647", "2147483648", "4294967296",
    "9223372036854775808", "-9223372036854775809", "1" + "0" * 400, "9" * 5000, "0x10", "1_000",
    "1,5", "1d5", "１", "١", "٣.٤", "++1", "1e", ".", "",
)  # fmt: skip
WORDS = (
    "", " ", "x" * 1000, "x" * 100_000, "é", "😀", "\u202e", "\x00", "a\nb", "nan", "null", "true",
    "..", "../../etc/passwd", "/dev/zero", "%s%n", "{0}", "$(true)", "__class__", "a.b", "*", "[",
    "\\",
)  # fmt: skip
DEPTHS = (40, 300, 5000, 100_000)
DEEP = "@@deep{}@@"
"""In a record stands for a list nested so deep, which no writer of Python's would write."""


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


def spoilt_record(rng, good):
    """A copy with one to three values replaced, removed, renamed, doubled or exchanged."""
    record = copy.deepcopy(good)
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        everywhere = list(places(record))
        if not everywhere:
            return _any_value(rng, record)
        place = rng.choice(everywhere)
        above = value_at(record, place[:-1])
        key = place[-1]
        kind = rng.random()
        if kind < 0.65:
            above[key] = _other_value(rng, above[key])
        elif kind < 0.75:
            above[key] = copy.deepcopy(value_at(record, rng.choice(everywhere)))
        elif kind < 0.85:
            del above[key]
        elif isinstance(above, list):
            above[key:key] = [above[key]] * rng.choice((1, 2, 1000))
        else:
            above[rng.choice((f"{key}x", key[:-1], key.upper(), *WORDS))] = above.pop(key)
    return record


def _other_value(rng, old):
    if isinstance(old, bool | None) or rng.random() < 0.35:
        return _any_value(rng, old)
    if isinstance(old, int | float):
        size = 10.0 ** rng.randint(-20, 20)
        whole = int(old) if abs(old) < 1e300 else 0
        of_float = float(min(max(old, -1e308), 1e308))
        near = (
            -old,
            of_float * size,
            float(np.nextafter(of_float, np.inf)),
            old + 1,
            whole,
            str(of_float),
            0,
        )
        return rng.choice((*near, any_number(rng)))
    if isinstance(old, str):
        return rng.choice((old + "x", old[:-1], old.upper(), old * 50, rng.choice(WORDS)))
    return [old] if rng.random() < 0.5 else type(old)()


def _any_value(rng, old):
    depth = DEEP.format(rng.choice(DEPTHS))
    values = (None, True, False, [], {}, [[]], [old], {"a": old}, [0.0] * 1000, depth)
    return rng.choice((any_number(rng), any_number(rng), rng.choice(WORDS), rng.choice(values)))


def any_number(rng):
    """A number that a field may not be ready for."""
    special = (
        float("nan"), float("inf"), -float("inf"), 1e308, -1e308, 5e-324, 1e-323, -0.0, 0, -1, 1,
        1e-160, 1e160, 1e15, 1e16, 2**31, 2**63, 10**400, 10**5000, 0.1, -1e-3, 1e12, 1e-12,
    )  # fmt: skip
    return rng.choice(special)


def json_text(record):
    """A record as JSON, with NaN and half characters, as deep as its marks say."""
    return _deepened(_python_json(record))


def toml_text(record):
    """A record as inline TOML."""
    if not isinstance(record, dict):
        return _deepened(_toml(record))
    return _deepened("".join(f"{_python_json(k)} = {_toml(v)}\n" for k, v in record.items()))


def _toml(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_python_json(k)} = {_toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    if isinstance(value, str | bool) or value is None:
        return _python_json(value)
    return _digits(value) if isinstance(value, int) else repr(value)


def _python_json(value):
    if isinstance(value, dict):
        pairs = (f"{_python_json(str(k))}: {_python_json(v)}" for k, v in value.items())
        return "{" + ", ".join(pairs) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_python_json, value)) + "]"
    if isinstance(value, int) and not isinstance(value, bool):
        return _digits(value)
    return json.dumps(value)


def _digits(value):
    return str(value) if abs(value) < 10**4000 else "1" + "0" * 5000  # Python refuses to write it


def _deepened(text):
    for depth in DEPTHS:
        text = text.replace(json.dumps(DEEP.format(depth)), "[" * depth + "]" * depth)
    return text.encode(errors="surrogatepass")
