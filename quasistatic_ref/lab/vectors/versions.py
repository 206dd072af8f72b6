"""The version of the vectors, and what it froze: within a version no case of a layer changes.

``versions.toml`` has for each version the SHA-256 of each layer, which is that of its inputs' file
followed by that of its expected outputs. A version that stands there is never edited.
"""

import hashlib
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import bytes_read, json_read
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.lab.vectors.layers import LAYERS

NAME = "quasi-dynamic vectors"
"""What the vectors are called, before their version."""
MANIFEST = "manifest.json"
FORMAT = "quasistatic-ref/vectors-manifest"
FORMAT_VERSION = 1
PLAIN = re.compile(r"(\w[\w.-]*/)*\w[\w.-]*")
"""Paths in a manifest: none leads out of its folder."""
RELEASE = 9
"""The version: counted up whenever an input or an expected output changes."""


@dataclass(frozen=True)
class Edition:
    """A folder of vectors: its version, and whether its layers are as that has them.

    Parameters
    ----------
    release : int or None
        Its version; None if its manifest is missing.
    hashes : dict of str to str
        SHA-256 of each layer that is there.
    changed : tuple of str
        Layers that are not as the version froze them; all, if it is not known.
    """

    release: int | None
    hashes: dict[str, str]
    changed: tuple[str, ...]

    @property
    def name(self) -> str:
        """E.g. ``quasi-dynamic vectors 3``, or ``quasi-dynamic vectors of no version``."""
        return f"{NAME} {'of no version' if self.release is None else self.release}"


def frozen_hashes(release: int | None) -> dict[str, str]:
    """SHA-256 of each layer of a version; none of one that is not known."""
    text = (Path(__file__).parent / "versions.toml").read_text("utf-8")
    found: dict[str, str] = tomllib.loads(text).get(str(release), {})
    return found


def layer_hash(folder: Path, layer: str) -> str:
    """SHA-256 of a layer: of the file of its inputs, followed by that of its expected outputs."""
    parts = (bytes_read(folder / part / f"{layer}.json") for part in ("inputs", "expected"))
    return hashlib.sha256(b"".join(parts)).hexdigest()


def edition(folder: Path) -> Edition:
    """Which version a folder of vectors is.

    Raises
    ------
    InputError
        If a file cannot be read.
    """
    known = [name for name in LAYERS if (folder / "expected" / f"{name}.json").exists()]
    hashes = {name: layer_hash(folder, name) for name in known}
    release = manifest(folder)[0] if (folder / MANIFEST).exists() else None
    wanted = frozen_hashes(release)
    return Edition(
        release, hashes, tuple(name for name in known if hashes[name] != wanted.get(name))
    )


def manifest(folder: Path) -> tuple[int, dict[str, str]]:
    """The version that a folder of vectors names, and SHA-256 of its files by their paths inside.

    Raises
    ------
    InputError
        If its manifest is missing, or is none.
    """
    path = folder / MANIFEST
    files = {}
    try:
        top = TableReader(json_read(path))
        top.check_format(FORMAT, FORMAT_VERSION)
        release = top.integer("release", least=1)
        for i, entry in enumerate(top.sequence("files")):
            one = TableReader(entry, f"files[{i}]")
            name = one.text("path")
            if not PLAIN.fullmatch(name):
                raise one.error_about("path", "is no path inside the folder", name)
            files[name] = one.text("sha256")
    except InputError as error:
        raise error.in_file(path) from None
    return release, files
