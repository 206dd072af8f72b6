"""The folder in which the compiled library is kept.

Whoever can write there can run code as this user. So the folder and the library are used only if
they belong to this user, are no links, and nobody else may write them. The name of a library ends
in the digest of its bytes, which is compared before each load: a library that was cut short, or in
which a bit has changed, would end the process without a word.
"""

import hashlib
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


class CompileError(Exception):
    """Why there is no library, in words."""


class Cache:
    """What is kept of one library.

    Parameters
    ----------
    key : str
        Follows from all that the library is made of.

    Attributes
    ----------
    folder : Path
        It is made if it is not there.

    Raises
    ------
    CompileError
        If the folder is not safe.
    """

    def __init__(self, key: str) -> None:
        self.folder = _folder()
        self._name = f"fast-{key[:16]}"
        self._loading = self.folder / f"{self._name}.loading"

    def library(self) -> Path | None:
        """The library, if one is kept and whole; other files of its name are removed."""
        for file in sorted(self.folder.glob(f"{self._name}-*")):
            if _bytes(file) is not None and file.name == self._named(file):
                return file
            self.remove(file)
        return None

    def keep(self, made: Path) -> Path:
        """Keep a library that was made in a folder of this one."""
        made.chmod(0o700)
        file = self.folder / self._named(made)
        os.replace(made, file)
        return file

    def remove(self, file: Path) -> None:
        """Remove a library that does not fit.

        Raises
        ------
        CompileError
        """
        try:
            file.unlink()
        except FileNotFoundError:  # another process has removed it
            pass
        except OSError as failure:
            problem = f"{file} is not a library of this user, and cannot be removed: {failure}"
            raise CompileError(problem) from None

    def was_left(self) -> bool:
        """Whether a process has begun to load the library and not gone on, as if it had ended."""
        return os.path.lexists(self._loading)

    @contextmanager
    def loading(self) -> Iterator[None]:
        """While the library is loaded: if that ends the process, the next one knows it."""
        with suppress(OSError):  # in a folder that is read-only
            self._loading.touch(0o600)
        yield
        with suppress(OSError):
            self._loading.unlink()

    def _named(self, file: Path) -> str:
        return f"{self._name}-{hashlib.sha256(_bytes(file) or b'').hexdigest()[:32]}.so"


def _folder() -> Path:
    """The user's cache folder for this package."""
    try:
        of_user = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    except RuntimeError:
        problem = "there is no home folder to keep it in: set XDG_CACHE_HOME or HOME"
        raise CompileError(problem) from None
    folder = of_user / "quasistatic_ref"
    if not os.path.lexists(folder):
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    found = folder.lstat()
    if not stat.S_ISDIR(found.st_mode):
        raise CompileError(f"{folder} is no folder: remove it, or set XDG_CACHE_HOME")
    if found.st_uid != os.geteuid():
        raise CompileError(f"{folder} belongs to another user: set XDG_CACHE_HOME")
    if _others_may_write(found):
        raise CompileError(
            f"others may write in {folder}: empty it, since they may have put libraries there, "
            "and take their right by chmod go-w"
        )
    return folder


def _bytes(file: Path) -> bytes | None:
    """The bytes of an ordinary file that is this user's, and that nobody else may write."""
    try:
        # A FIFO would wait for a writer without the second flag.
        opened = os.open(file, os.O_RDONLY | os.O_NONBLOCK | os.O_NOFOLLOW)
    except OSError:
        return None
    found = os.fstat(opened)
    if not stat.S_ISREG(found.st_mode):
        os.close(opened)
        return None
    with os.fdopen(opened, "rb") as held:
        safe = found.st_uid == os.geteuid() and not _others_may_write(found)
        return held.read() if safe else None


def _others_may_write(found: os.stat_result) -> bool:
    return bool(found.st_mode & (stat.S_IWGRP | stat.S_IWOTH))
