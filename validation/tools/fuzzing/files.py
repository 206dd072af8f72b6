"""Good files made wrong: their bytes, their tokens, their records and arrays, from one seed."""

from __future__ import annotations

import functools
import io
import json
import lzma
import re
import tokenize
import tomllib
import warnings
import zipfile
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.oracles.records import (
    NUMBERS,
    WORDS,
    Rng,
    any_number,
    json_text,
    spoilt_record,
    toml_text,
)

TOKEN = re.compile(rb"[-+]?\d[\w.+-]*|[A-Za-z_][\w:.-]*|\"[^\"\n]*\"|[^\w\s]")
BOMB = 2**28 + 1
"""Zeros [bytes], more than the unpacked rows of a study may have."""


def spoilt_bytes(rng: Rng, good: bytes) -> bytes:
    """A few bytes changed, a piece cut out, doubled or moved, or the end cut off."""
    content = bytearray(good)
    at, to = sorted(rng.randrange(len(good) + 1) for _ in "ab") if good else (0, 0)
    match rng.randrange(5):
        case 0:
            del content[at:to]
        case 1:
            content[at:at] = content[at : min(to, at + 1000)]
        case 2:
            content[at:] = rng.randbytes(rng.randrange(20))
        case _:
            for _ in range(rng.randint(1, 4) if content else 0):
                content[rng.randrange(len(content))] = rng.choice(
                    (0, 10, 32, 255, rng.randrange(256))
                )
    return bytes(content)


def spoilt_tokens(rng: Rng, good: bytes) -> bytes:
    """One to three tokens of a text replaced, most of them numbers by other numbers; or lines."""
    if rng.random() < 0.15:
        lines = good.splitlines(keepends=True) or [b""]
        at = rng.randrange(len(lines))
        lines[at : at + rng.randint(0, 2)] = [rng.choice(lines)] * rng.choice((0, 1, 2, 50))
        return b"".join(lines)
    content = good
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        tokens = list(TOKEN.finditer(content))
        numbers = [t for t in tokens if t[0][:1].isdigit() or (t[0][:1] in b"+-" and len(t[0]) > 1)]
        among = numbers if numbers and rng.random() < 0.6 else tokens
        if not among:
            return spoilt_bytes(rng, content)
        token = rng.choice(among)
        new = _other_token(rng, token[0], tokens)
        content = content[: token.start()] + new + content[token.end() :]
    return content


def _other_token(rng: Rng, old: bytes, tokens: Sequence[re.Match[bytes]]) -> bytes:
    kind = rng.random()
    if kind < 0.4:
        return rng.choice(NUMBERS).encode()
    if kind < 0.5:
        word = rng.choice(WORDS).encode()
        return b'"%b"' % word if old[:1] == b'"' else word
    if kind < 0.8:
        return rng.choice(tokens)[0]
    if kind < 0.9:
        return old + rng.choice((b" ", b"\n", b"", b".", b"e9")) + old
    return b""


def spoilt_array(rng: Rng, good: NDArray[Any]) -> NDArray[Any]:
    """Another type, another shape, more or fewer entries, or other numbers."""
    array = np.array(good)
    kind = rng.randrange(8)
    if kind == 0:
        return np.zeros(
            array.shape, rng.choice(("f4", ">f8", "f2", "?", "c16", "U3", "M8[s]", "f8,i4"))
        )
    if kind == 1:
        return np.zeros(
            rng.choice(((), (0,), (0, 3), (1,) * 30, (*array.shape, 1), array.shape[1:]))
        )
    if kind == 2:
        return np.asfortranarray(array.T)
    if kind == 3 and array.ndim:
        return np.concatenate([array[: rng.randint(0, len(array))]] * rng.choice((1, 2)))
    if array.dtype.kind in "fiu" and array.size:
        for _ in range(rng.randint(1, 3)):
            try:
                array.flat[rng.randrange(array.size)] = any_number(rng)
            except (OverflowError, ValueError):  # no such number has this type
                array = array.astype("f8")
    return array


def npy_bytes(array: NDArray[Any]) -> bytes:
    """An array as an ``.npy`` file."""
    file = io.BytesIO()
    np.lib.format.write_array(file, array)
    return file.getvalue()


def zip_bytes(members: Sequence[tuple[str, bytes]], pack: int = zipfile.ZIP_STORED) -> bytes:
    """Members as a ZIP file whose checksums are right."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", pack) as archive, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a name given twice
        for name, content in members:
            archive.writestr(zipfile.ZipInfo(name), content, pack)  # without the time of day
    return file.getvalue()


def spoilt_text(rng: Rng, good: bytes) -> bytes:
    """A text, or a file with a text for a header."""
    return (spoilt_bytes if rng.random() < 0.25 else spoilt_tokens)(rng, good)


def spoilt_json(rng: Rng, good: bytes) -> bytes:
    """A JSON file, mostly by its values."""
    try:
        record = json.loads(good)
    except (ValueError, RecursionError):  # spoilt before
        return spoilt_bytes(rng, good)
    return spoilt_text(rng, good) if rng.random() < 0.3 else json_text(spoilt_record(rng, record))


def spoilt_toml(rng: Rng, good: bytes) -> bytes:
    """A TOML file, mostly by its values."""
    if rng.random() < 0.3:
        return spoilt_text(rng, good)
    return toml_text(spoilt_record(rng, tomllib.loads(good.decode())))


def spoilt_lines(rng: Rng, good: bytes) -> bytes:
    """A file of one JSON object a line, by one of its lines or by their order."""
    lines = good.splitlines(keepends=True)
    at = rng.randrange(len(lines))
    if rng.random() < 0.1:
        lines[at : at + 2] = lines[at : at + 2][::-1] * rng.choice((0, 1, 2))
    else:
        lines[at] = spoilt_json(rng, lines[at].rstrip(b"\n")) + b"\n"
    return b"".join(lines)


def spoilt_xz(rng: Rng, good: bytes) -> bytes:
    """The same, packed; or a file that unpacks to more than rows may have."""
    chance = rng.random()
    if chance < 0.15:
        return spoilt_bytes(rng, good)
    if chance < 0.16:
        return _bomb()
    return lzma.compress(spoilt_lines(rng, lzma.decompress(good)), preset=0)


@functools.cache
def _bomb() -> bytes:
    return lzma.compress(bytes(BOMB), preset=0)


def spoilt_npy(rng: Rng, good: bytes) -> bytes:
    """An array's file: its header, its bytes, or the array."""
    if rng.random() < 0.5:
        head, _, rest = good.partition(b"\n")
        return (
            spoilt_text(rng, head) + b"\n" + rest if rng.random() < 0.7 else spoilt_bytes(rng, good)
        )
    try:
        array = np.load(io.BytesIO(good), allow_pickle=False)
    except (ValueError, OSError, SyntaxError, MemoryError, tokenize.TokenError):  # spoilt before
        return spoilt_bytes(rng, good)
    return npy_bytes(spoilt_array(rng, array))


def spoilt_npz(rng: Rng, good: bytes) -> bytes:
    """A ZIP file of arrays: its bytes, its names, one of its arrays or the JSON in one of them."""
    if rng.random() < 0.1:
        return spoilt_bytes(rng, good)
    with zipfile.ZipFile(io.BytesIO(good)) as archive:
        members = [(name, archive.read(name)) for name in archive.namelist()]
    for _ in range(rng.choice((1, 1, 2))):
        at = rng.randrange(len(members))
        if rng.random() < 0.3:  # the first is a trajectory's header
            at = 0
        name, content = members[at]
        kind = rng.random()
        if kind < 0.1:
            members[at] = (
                rng.choice((*WORDS[1:3], f"{name}x", "a\nb.npy", members[0][0])),
                content,
            )
        elif kind < 0.2:
            members[at : at + 1] = [members[at]] * rng.choice((0, 2, 300))
        elif name == "header.npy" and b"{" in content[128:]:
            record = content[content.index(b"{", 128) :]
            members[at] = name, npy_bytes(np.frombuffer(spoilt_json(rng, record), np.uint8))
        else:
            members[at] = name, spoilt_npy(rng, content)
        if not members:
            break
    return zip_bytes(members, rng.choice((zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)))


Form = Callable[[Rng, bytes], bytes]
