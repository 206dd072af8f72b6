"""What a folder of vectors holds: each file's SHA-256, the number of cases, the release."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Final

from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.files import VERSION, lines

MANIFEST: Final = "manifest.json"
FORMAT: Final = "quasistatic-ref/vectors-manifest"
RELEASE: Final = 2
"""Counted up whenever an input or an expected output changes."""


def manifest_text(files: dict[str, bytes]) -> str:
    """The manifest of a folder, given the content of its other files.

    Parameters
    ----------
    files : dict of str to bytes
        By path inside the folder, with forward slashes.
    """
    listed = [
        {"path": path, "bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}
        for path, content in sorted(files.items())
    ]
    cases = {
        Path(path).stem: len(json.loads(content)["cases"])
        for path, content in files.items()
        if path.startswith("expected/")
    }
    record: dict[str, Json] = {
        "format": FORMAT,
        "version": VERSION,
        "release": RELEASE,
        "cases": cases,
        "files": listed,
    }
    return lines(record, listed=("files",))
