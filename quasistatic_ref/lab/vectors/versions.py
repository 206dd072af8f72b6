"""The version of the vectors: within a version no case of a layer changes."""

import re
from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import json_read
from quasistatic_ref.formats.table_reader import TableReader

MANIFEST = "manifest.json"
FORMAT = "quasistatic-ref/vectors-manifest"
FORMAT_VERSION = 1
PLAIN = re.compile(r"(\w[\w.-]*/)*\w[\w.-]*")
"""Paths in a manifest: none leads out of its folder."""
RELEASE = 10
"""The version: counted up whenever an input or an expected output changes."""


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
