"""Files, written whole or not at all, and read with plain errors."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

import numpy as np

from quasistatic_ref.errors import InputError

LARGEST = 512 * 2**20


def written_whole(path: str | Path, write: Callable[[IO[bytes]], None]) -> Path:
    """Write a file under a temporary name in the same folder, then rename it.

    Parameters
    ----------
    path : str or Path
        Missing folders are made.
    write : callable
        Receives the open binary file.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        If the folder cannot be written to; nothing is left behind.
    """
    path = Path(path)
    temporary = ""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        descriptor, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        with os.fdopen(descriptor, "wb") as file:
            write(file)
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(temporary, 0o666 & ~umask)
        os.replace(temporary, path)
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(f"cannot be written: {reason}; choose another folder", file=path) from None
    finally:
        if temporary and os.path.exists(temporary):
            os.unlink(temporary)
    return path


def text_written(path: str | Path, text: str) -> Path:
    """Write a text file whole, in UTF-8."""
    return written_whole(path, lambda file: _write_text(file, text))


def _write_text(file: IO[bytes], text: str) -> None:
    file.write(text.encode("utf-8"))


def bytes_read(path: str | Path, error: type[InputError] = InputError) -> bytes:
    """The content of a file.

    Parameters
    ----------
    path : str or Path
    error : type
        The :class:`~quasistatic_ref.errors.InputError` to raise.

    Raises
    ------
    InputError
        If it is missing, not a file, not readable, or larger than any input should be.
    """
    path = Path(path)
    try:
        if path.stat().st_size > LARGEST:
            raise error(f"is larger than {LARGEST // 2**20} MiB", file=path)
        return path.read_bytes()
    except FileNotFoundError:
        raise error("no such file", file=path) from None
    except (OSError, ValueError) as failure:  # ValueError: a NUL character in the name
        reason = getattr(failure, "strerror", None) or str(failure)
        raise error(f"cannot be read: {reason}", file=path) from None


def text_of(content: bytes, path: str | Path, error: type[InputError] = InputError) -> str:
    """Content as text; a byte-order mark is dropped. InputError if it is not UTF-8."""
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as failure:
        line = content[: failure.start].count(b"\n") + 1
        raise error("is not UTF-8 text", file=path, field=f"line {line}") from None


def json_read(path: str | Path) -> Any:
    """The value in a JSON file; InputError if it does not parse."""
    try:
        return json.loads(text_of(bytes_read(path), path))
    except json.JSONDecodeError as error:
        raise InputError(f"is not JSON: {error}", file=path) from None
    except (RecursionError, ValueError):  # nested too deeply, or an integer of too many digits
        raise InputError("is not usable JSON: too deep, or a number too long", file=path) from None


def plain(value: Any) -> Any:
    """NumPy arrays and numbers as lists and numbers that JSON holds; -0.0 becomes 0.0."""
    if isinstance(value, np.ndarray):
        return (value + 0.0).tolist() if value.dtype.kind == "f" else value.tolist()
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float):
        return value + 0.0
    if isinstance(value, dict):
        return {key: plain(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    return value


def json_text(value: Any) -> str:
    """One line of JSON; floats in shortest round-trip decimal. NaN and infinity are refused."""
    return json.dumps(plain(value), allow_nan=False, ensure_ascii=False)
