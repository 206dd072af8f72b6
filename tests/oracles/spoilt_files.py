"""Good files made wrong: their bytes, their tokens, their records and arrays, from one seed."""

import io
import json
import lzma
import re
import tomllib
import warnings
import zipfile

import numpy as np

from tests.oracles.records import (
    NUMBERS,
    WORDS,
    any_number,
    json_text,
    spoilt_record,
    toml_text,
)

TOKEN = re.compile(rb"[-+]?\d[\w.+-]*|[A-Za-z_][\w:.-]*|\"[^\"\n]*\"|[^\w\s]")
TYPES = ("f4", ">f8", "f2", "?", "c16", "U3", "M8[s]", "f8,i4")


def spoilt_bytes(rng, good):
    """A byte changed, a piece cut out or doubled, or the end cut off."""
    at, to = sorted(rng.randrange(len(good) + 1) for _ in "ab")
    changed = bytes([rng.choice((0, 10, 32, 255, rng.randrange(256)))])
    kinds = (
        good[:at] + changed + good[at + 1 :],
        good[:at] + good[to:],
        good[:to] + good[at:],
        good[:at] + rng.randbytes(rng.randrange(20)),
    )
    return rng.choice(kinds)


def spoilt_text(rng, good):
    """Some tokens of a text replaced by numbers, words or other tokens; or its bytes changed."""
    content = good
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        tokens = list(TOKEN.finditer(content))
        if not tokens or rng.random() < 0.25:
            content = spoilt_bytes(rng, content)
            continue
        token = rng.choice(tokens)
        other = rng.choice(tokens)[0]
        word = rng.choice(WORDS).encode()
        new = rng.choice((rng.choice(NUMBERS).encode(), word, b'"%b"' % word, other, b""))
        content = content[: token.start()] + new + content[token.end() :]
    return content


def spoilt_json(rng, good):
    """A JSON file, mostly by its values."""
    if rng.random() < 0.3:
        return spoilt_text(rng, good)
    return json_text(spoilt_record(rng, json.loads(good)))


def spoilt_toml(rng, good):
    """A TOML file, mostly by its values."""
    if rng.random() < 0.3:
        return spoilt_text(rng, good)
    return toml_text(spoilt_record(rng, tomllib.loads(good.decode())))


def spoilt_lines(rng, good):
    """A file of one JSON object a line, by one of its lines."""
    lines = good.splitlines(keepends=True)
    at = rng.randrange(len(lines))
    lines[at] = spoilt_json(rng, lines[at].rstrip(b"\n")) + b"\n"
    return b"".join(lines)


def spoilt_xz(rng, good):
    """The same, packed."""
    if rng.random() < 0.15:
        return spoilt_bytes(rng, good)
    return lzma.compress(spoilt_lines(rng, lzma.decompress(good)), preset=0)


def spoilt_array(rng, good):
    """Another type, another shape, or another number."""
    array = np.array(good)
    kinds = (
        lambda: np.zeros(array.shape, rng.choice(TYPES)),
        lambda: np.zeros(rng.choice(((), (0,), (0, 3), (1,) * 30, (*array.shape, 1)))),
        lambda: np.asfortranarray(array.T),
        lambda: np.concatenate([array.ravel()] * 2),
    )
    if array.dtype.kind != "f" or not array.size or rng.random() < 0.5:
        return rng.choice(kinds)()
    try:
        number = float(any_number(rng))
    except OverflowError:  # a whole number of many digits
        number = np.inf
    with np.errstate(over="ignore"):  # in single precision
        array.flat[rng.randrange(array.size)] = number
    return array


def npy_bytes(array):
    """An array as an ``.npy`` file."""
    file = io.BytesIO()
    np.lib.format.write_array(file, array)
    return file.getvalue()


def spoilt_npy(rng, good):
    """An array's file: its header, its bytes, or the array."""
    head, _, rest = good.partition(b"\n")
    kind = rng.random()
    if kind < 0.35:
        return spoilt_text(rng, head) + b"\n" + rest
    if kind < 0.5:
        return spoilt_bytes(rng, good)
    return npy_bytes(spoilt_array(rng, np.load(io.BytesIO(good), allow_pickle=False)))


def zip_bytes(members, pack=zipfile.ZIP_STORED):
    """Members as a ZIP file whose checksums are right."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", pack) as archive, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a name given twice
        for name, content in members:
            archive.writestr(zipfile.ZipInfo(name), content, pack)  # without the time of day
    return file.getvalue()


def spoilt_npz(rng, good):
    """A ZIP file of arrays: its bytes, its names, one of its arrays or the JSON in one of them."""
    if rng.random() < 0.1:
        return spoilt_bytes(rng, good)
    with zipfile.ZipFile(io.BytesIO(good)) as archive:
        members = [(name, archive.read(name)) for name in archive.namelist()]
    at = 0 if rng.random() < 0.3 else rng.randrange(len(members))  # a trajectory's header is first
    name, content = members[at]
    kind = rng.random()
    if kind < 0.1:
        members[at] = rng.choice((*WORDS[1:3], f"{name}x", "a\nb.npy", members[0][0])), content
    elif kind < 0.2:
        members[at : at + 1] = [members[at]] * rng.choice((0, 2, 300))
    elif name == "header.npy":
        record = content[content.index(b"{", 128) :]
        members[at] = name, npy_bytes(np.frombuffer(spoilt_json(rng, record), np.uint8))
    else:
        members[at] = name, spoilt_npy(rng, content)
    return zip_bytes(members, rng.choice((zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)))
