"""Compiles the C files of ``quasistatic_ref/optional/compiled`` when the package is installed.

A wheel with the library is for one platform and any Python 3. An editable installation finds the
library where it is made, next to its sources. Without a C compiler, or with the variable
QUASISTATIC_REF_COMPILED=0, the installation goes on, and a file in the library's place says why:
such a wheel is for any platform.
"""

import runpy
import sysconfig
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

BUILD = "quasistatic_ref/optional/compiled/build.py"


class CompiledCode(BuildHookInterface):
    """The hook that pyproject.toml names for wheels."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Make the library, and have the wheel carry it."""
        root = Path(self.root)
        build = runpy.run_path(str(root / BUILD))
        file = build["build"]()
        build_data["artifacts"].append(file.relative_to(root).as_posix())
        if file == build["LIBRARY"]:
            platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
            build_data["pure_python"] = False
            build_data["tag"] = f"py3-none-{platform}"
