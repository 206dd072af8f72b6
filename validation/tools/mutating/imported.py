"""Tests of a package one file of which is another when it is imported.

``python -m validation.tools.mutating.imported FILE TEXT TEST...`` runs tests on the package with
the file FILE read from TEXT, for mutants that change more than functions.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from importlib.util import spec_from_file_location
from pathlib import Path
from types import ModuleType

import pytest

from validation.tools.mutating.forks import more_time


class Replaced(SourceFileLoader):
    """Loads a module whose text is another file's."""

    text: Path

    def get_code(self, fullname: str) -> object:
        """Compile the other text; what is compiled already is not taken."""
        return self.source_to_code(self.text.read_bytes(), self.get_filename(fullname))


class Finder(MetaPathFinder):
    """Finds one file of the package, with another text."""

    def __init__(self, file: Path, text: Path) -> None:
        self.file, self.text = file, text

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Hand out the file, and leave every other to Python."""
        spec = PathFinder.find_spec(name, path, target)
        if spec is None or spec.origin is None or Path(spec.origin) != self.file:
            return None
        loader = Replaced(name, str(self.file))
        loader.text = self.text
        return spec_from_file_location(name, self.file, loader=loader)


if __name__ == "__main__":
    more_time(120)
    sys.meta_path.insert(0, Finder(Path(sys.argv[1]), Path(sys.argv[2])))
    sys.exit(pytest.main(["-x", "-q", "-p", "no:cacheprovider", *sys.argv[3:]]))
