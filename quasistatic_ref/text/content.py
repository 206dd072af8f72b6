"""Files, written whole or not at all, and read with plain errors."""

import io
import json
import os
import re
import stat
import sys
import tempfile
import tomllib
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import IO, Any, cast

from quasistatic_ref.errors import InputError, about_file, check_kind
from quasistatic_ref.quoting import slash_remedy

LARGEST = 512 * 2**20
"""Largest file that is read [bytes]."""
LARGEST_TEXT = 64 * 2**20
"""Largest JSON file [bytes]: a step with 300 coordinates and 1000 contacts has 30 MiB."""
LARGEST_TOML = 2**20
"""Largest TOML file [bytes]."""
MOST_PARTS = 10
"""Most parts of a dotted key: a parser of TOML takes memory with the square of their number."""
_PART = r"""(?:[\w-]+|"(?:[^"\\\n]|\\[^\n])*"|'[^'\n]*')"""
LONG_KEY = re.compile(rf"(?<![\w.-]){_PART}(?:[ \t]*\.[ \t]*{_PART}){{{MOST_PARTS}}}", re.ASCII)
PARTIAL = ".partial"
"""End of the names of files that are being written."""


def checked_path(path: object) -> Path:
    """A path from a text or a path; InputError of anything else."""
    check_kind(path, str | os.PathLike, "path", "a path")
    return Path(cast("str", path))


def written_whole(path: str | os.PathLike[str], write: Callable[[IO[bytes]], object]) -> Path:
    """Write a file under a temporary name in the same folder, then rename it.

    Parameters
    ----------
    path : str or Path
        Missing folders are made. A device or a pipe, and whatever stands in ``/dev``, is written
        into at once; behind a symbolic link, the file that it leads to is replaced.
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
    path = checked_path(path)
    try:
        if is_stream(path):
            content = io.BytesIO()
            write(content)
            with path.open("ab") as stream:
                stream.write(content.getbuffer())
        else:
            _replaced(_resolved(path), write)
    except OSError as error:
        raise _unwritable(error, path) from None
    return path


def is_stream(path: Path) -> bool:
    """Whether a path is a stream, such as a pipe or a file in /dev."""
    target = _resolved(path)
    is_special = target.exists() and not target.is_file() and not target.is_dir()
    return is_special or path.is_relative_to("/dev")


def _replaced(target: Path, write: Callable[[IO[bytes]], object]) -> None:
    """Write a regular file whole."""
    target.parent.mkdir(parents=True, exist_ok=True)
    _swept(target.parent)
    descriptor, temporary = tempfile.mkstemp(PARTIAL, f".{target.name}.", target.parent)
    is_locked = _locked(descriptor, wait=True)
    if not os.path.exists(temporary):  # another process has swept it before it was locked
        os.close(descriptor)
        return _replaced(target, write)
    try:
        with os.fdopen(descriptor, "wb") as file:
            write(file)
            file.flush()
            if is_locked:  # until it has its name
                _named(temporary, target)
        if not is_locked:
            _named(temporary, target)
    finally:
        Path(temporary).unlink(missing_ok=True)


def _named(temporary: str, target: Path) -> None:
    umask = os.umask(0)
    os.umask(umask)
    os.chmod(temporary, 0o666 & ~umask)
    os.replace(temporary, target)


@cache
def _swept(folder: Path) -> None:
    """Remove half-written files of killed processes from a folder, once in each process."""
    for path in folder.glob(f".*{PARTIAL}"):
        with suppress(OSError), path.open("rb") as file:
            if _locked(file.fileno()):
                path.unlink()


def _locked(descriptor: int, *, wait: bool = False) -> bool:
    """Lock a file until it is closed; tell whether that is possible, and no other process did.

    A file that is made is locked by others as long as they sweep its folder: it may `wait`.
    """
    if sys.platform == "win32":
        return False
    import fcntl

    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except OSError:
        return False
    return True


def _resolved(path: Path) -> Path:
    try:
        return path.resolve()
    except (ValueError, RuntimeError) as error:  # a NUL character; links in a circle
        raise _unwritable(error, path) from None


def writable_folder(folder: str | os.PathLike[str]) -> Path:
    """Make a folder and see that files can be written there, before work is done for them.

    Raises
    ------
    InputError
        If they cannot.
    """
    folder = Path(folder)
    try:
        _resolved(folder).mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder) as file:
            file.write(b"?")
    except OSError as error:
        raise _unwritable(error, folder) from None
    return folder


def _unwritable(error: Exception, path: Path) -> InputError:
    reason = getattr(error, "strerror", None) or str(error)
    return InputError(f"cannot be written: {reason}; choose another folder", file=path)


def text_written(path: str | os.PathLike[str], text: str) -> Path:
    """Write a text file whole, in UTF-8."""
    return bytes_written(path, text.encode("utf-8"))


def bytes_written(path: str | os.PathLike[str], content: bytes) -> Path:
    """Write a file whole."""
    return written_whole(path, lambda file: file.write(content))


def bytes_read(
    path: str | os.PathLike[str], error: type[InputError] = InputError, largest: int = LARGEST
) -> bytes:
    """The content of a file.

    Parameters
    ----------
    path : str or Path
    error : type
        The :class:`~quasistatic_ref.errors.InputError` to raise.
    largest : int
        Largest size that is read [bytes].

    Raises
    ------
    InputError
        If it is missing, not a file, not readable, or larger than any input should be.
    """
    path = checked_path(path)
    try:
        status = path.stat()
        # Devices and pipes may never end, or never begin.
        if not stat.S_ISREG(status.st_mode) and not stat.S_ISDIR(status.st_mode):
            raise error("cannot be read: it is a device or a pipe, not a file", file=path)
        if status.st_size > largest:
            raise error(f"is larger than {largest / 2**20:g} MiB", file=path)
        return path.read_bytes()
    except FileNotFoundError:
        remedy = slash_remedy(Path(path).as_posix())
        raise error(f"no such file{remedy}", file=path) from None
    except InputError:
        raise
    except (OSError, ValueError) as failure:  # ValueError: a NUL character in the name
        reason = getattr(failure, "strerror", None) or str(failure)
        raise error(f"cannot be read: {reason}", file=path) from None


def text_of(
    content: bytes, path: str | os.PathLike[str], error: type[InputError] = InputError
) -> str:
    """Content as text; a byte-order mark is dropped. InputError if it is not UTF-8."""
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as failure:
        if content.startswith(b"PK"):
            problem = "is a ZIP archive, as a trajectory is, and not text"
            raise error(problem, file=path) from None
        line = content[: failure.start].count(b"\n") + 1
        problem = "is not UTF-8 text; save it as UTF-8"
        raise error(problem, file=path, field=f"line {line}") from None


def text_read(
    path: str | os.PathLike[str], error: type[InputError] = InputError, largest: int = LARGEST
) -> str:
    """The text of a file, as :func:`bytes_read` and :func:`text_of` have it."""
    return text_of(bytes_read(path, error, largest), path, error)


def json_read(path: str | os.PathLike[str]) -> Any:
    """The value in a JSON file; InputError if it does not parse, or names a field twice."""
    try:
        with about_file(path):
            text = text_read(path, largest=LARGEST_TEXT)
            value = json.loads(text, object_pairs_hook=unique_fields)
            _check_characters(text, value)
    except json.JSONDecodeError as error:
        raise InputError(f"is not JSON: {error}", file=path) from None
    except InputError:
        raise
    except (RecursionError, ValueError):  # nested too deeply, or an integer of too many digits
        raise InputError("is not usable JSON: too deep, or a number too long", file=path) from None
    return value


def _check_characters(text: str, value: object) -> None:
    r"""Refuse half of a surrogate pair, ``"\ud800"``, which no file in UTF-8 can hold."""
    if "\\ud" in text.lower():
        try:
            json.dumps(value, ensure_ascii=False).encode()
        except UnicodeEncodeError:
            raise InputError("is not usable JSON: a string holds half of a character") from None


def toml_read(
    path: str | os.PathLike[str], error: type[InputError] = InputError, what: str = "TOML"
) -> dict[str, Any]:
    """The tables of a TOML file.

    Parameters
    ----------
    path : str or Path
    error : type
        The :class:`~quasistatic_ref.errors.InputError` to raise.
    what : str
        What a file of another ending should have been.

    Raises
    ------
    InputError
        If it cannot be read, or is something else.
    """
    with about_file(path):
        try:
            text = text_read(path, error, LARGEST_TOML)
            if long_key := LONG_KEY.search(text):
                line = text.count("\n", 0, long_key.start()) + 1
                problem = f"a key has more than {MOST_PARTS} parts"
                raise error(problem, field=f"line {line}")
            return tomllib.loads(text)
        except tomllib.TOMLDecodeError as failure:
            wanted = "TOML" if Path(path).suffix == ".toml" else what
            place = re.search(r"at line (\d+)", str(failure))
            content = text.split("\n")[int(place[1]) - 1] if place else ""
            remedy = slash_remedy(content) if "\\" in content else ""
            raise error(f"is not {wanted}: {failure}{remedy}") from None
        except InputError:
            raise
        except (RecursionError, ValueError):
            raise error("is nested too deeply, or holds an unusable number") from None


def unique_fields(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """A JSON object as a dict; InputError if a name comes twice (`json` keeps the last)."""
    fields: dict[str, Any] = {}
    for name, value in pairs:
        if name in fields:
            raise InputError("is given twice; leave one out", field=name, value=value)
        fields[name] = value
    return fields
