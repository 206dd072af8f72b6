"""The arrays of an ``.npz`` or ``.npy`` file from anywhere: no pickles, and only the size it says.

``numpy.load`` believes the shape in an array's header and asks for that much memory at once, and a
few kilobytes of ZIP can hold gigabytes of zeros. Here sizes are compared before anything is
unpacked.
"""

import io
import json
import lzma
import math
import tokenize
import warnings
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import InputError, about_file
from quasistatic_ref.text.content import LARGEST_TEXT, bytes_read, text_of, unique_fields
from quasistatic_ref.text.json_text import json_text

LARGEST_UNPACKED = 2**30
"""Largest sum of all arrays [bytes]: 50,000 full steps of the paper's size."""
MOST_ARRAYS = 256


class NoSuchArray(ValueError):
    """An array of a file is missing or unusable; the message says why."""


UNREADABLE: tuple[type[Exception], ...] = (
    ValueError,
    KeyError,
    TypeError,
    OSError,
    EOFError,
    RuntimeError,
    SyntaxError,
    OverflowError,  # a member that begins beyond any file
    tokenize.TokenError,  # an array's header with an open bracket
    zipfile.BadZipFile,
    zlib.error,
    lzma.LZMAError,
)
"""What zipfile and NumPy raise at a file that is something else, or spoilt."""


def npz_arrays(
    path: str | Path, what: str, only: str = "", missing: frozenset[bytes] = frozenset()
) -> dict[str, NDArray[Any]]:
    """Every array of a .npz file by name, of the shape and type that the file states.

    Parameters
    ----------
    path : str or Path
    what : str
        What the file must be, for the sentence on one that is something else.
    only : str, optional
        The one array that is unpacked.
    missing : frozenset of bytes
        Contents of members that stand for no array.

    Raises
    ------
    InputError
        If it is no such file, is spoilt, holds pickles, or unpacks to more than it should.
    """
    content = bytes_read(path)
    problem = f"is not {what}"
    with readable(path, problem), zipfile.ZipFile(io.BytesIO(content)) as archive:
        members = {_name(member, problem): member for member in _checked_sizes(archive)}
        arrays = {}
        for name, member in members.items():
            small = member.file_size <= max(map(len, missing), default=-1)
            if only in ("", name) and not (small and archive.read(member) in missing):
                with archive.open(member) as file:
                    arrays[name] = array_of(file, member.file_size, member.filename)
        return arrays


def npz_record(path: str | Path, what: str) -> tuple[Any, dict[str, NDArray[Any]]]:
    """The JSON header of a .npz file, and its other arrays, as :func:`npz_arrays` reads them.

    Returns
    -------
    header : object
    arrays : dict of str to ndarray
        Each of the shape that the file has.

    Raises
    ------
    InputError
        If the file cannot be read, or has no such header.
    """
    arrays = npz_arrays(path, what)
    return header_of(path, what, arrays.pop("header", None)), arrays


def header_of(path: str | Path, what: str, header: NDArray[Any] | None) -> Any:
    """What the array `header` of a file holds, shape (bytes,) [-]; InputError if it is not JSON."""
    with about_file(path):
        if header is None or header.dtype != np.uint8:
            raise InputError(f"is not {what}: it has no header")
        if header.size > LARGEST_TEXT:
            raise InputError(f"is not {what}: its header is too large")
        try:
            text = text_of(header.tobytes(), path)
            return json.loads(text, object_pairs_hook=unique_fields)
        except InputError:
            raise
        except (ValueError, RecursionError):
            raise InputError(f"is not {what}: its header is not JSON") from None


def json_array(header: Mapping[str, Any]) -> NDArray[np.uint8]:
    """A header as :func:`npz_record` reads it, shape (bytes,) [-]."""
    return np.frombuffer(json_text(dict(header)).encode(), dtype=np.uint8)


@contextmanager
def readable(path: str | Path, problem: str) -> Iterator[None]:
    """A context in which a failure to read a file becomes an InputError that says `problem`.

    NumPy warns of headers that Python 2 wrote, and Python of odd ones: nothing is printed.
    """
    try:
        with about_file(path), warnings.catch_warnings(action="ignore"):
            yield
    except InputError:
        raise
    except NoSuchArray as error:
        raise InputError(f"{problem}: {error}", file=path) from None
    except UNREADABLE:  # in words of zipfile and NumPy
        raise InputError(f"{problem}, or is spoilt", file=path) from None


def _checked_sizes(archive: zipfile.ZipFile) -> list[zipfile.ZipInfo]:
    members = archive.infolist()
    if len(members) > MOST_ARRAYS:
        raise InputError(f"holds more than {MOST_ARRAYS} arrays", value=len(members))
    seen: set[str] = set()
    for member in members:
        if member.filename in seen:
            raise InputError("is given twice; leave one out", field=member.filename)
        seen.add(member.filename)
    unpacked = sum(member.file_size for member in members)
    if unpacked > LARGEST_UNPACKED:
        most = LARGEST_UNPACKED / 2**30
        raise InputError(f"unpack to more than {most:g} GiB", field="its arrays", value=unpacked)
    return members


def _name(member: zipfile.ZipInfo, problem: str) -> str:
    if not member.filename.endswith(".npy"):
        raise InputError(problem, field=member.filename)
    return member.filename.removesuffix(".npy")


def array_of(file: IO[bytes], size: int, name: str) -> NDArray[Any]:
    """The array that an ``.npy`` file of some bytes holds, of any shape [its unit]; never a pickle.

    Raises
    ------
    NoSuchArray, ValueError
        If it is no such array; :func:`readable` says so of the file.
    """
    if np.lib.format.read_magic(file) != (1, 0):
        raise NoSuchArray(f"{name} is an array file of another version; write it by numpy.save")
    shape, _, kind = np.lib.format.read_array_header_1_0(file)
    if kind.hasobject:
        raise NoSuchArray(f"{name} is a pickle, which is never opened; save a dense array")
    byte_count = math.prod(
        shape, start=kind.itemsize
    )  # of Python's own numbers: it does not overflow
    if min(shape, default=0) < 0 or byte_count != size - file.tell():
        raise NoSuchArray(f"{name} does not have the size that it says; copy it again")
    file.seek(0)
    array: NDArray[Any] = np.lib.format.read_array(file, allow_pickle=False)
    return array
