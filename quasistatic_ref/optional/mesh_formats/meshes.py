"""What mesh files hold, by their extensions."""

from pathlib import Path

from quasistatic_ref.errors import ModelError
from quasistatic_ref.files.mesh import Mesh
from quasistatic_ref.optional.mesh_formats.files import malformed
from quasistatic_ref.optional.mesh_formats.mesh_texts import TEXTS
from quasistatic_ref.optional.mesh_formats.placed_meshes import placed_mesh
from quasistatic_ref.text.content import bytes_read


def file_mesh(path: Path, kind: str) -> Mesh:
    """What a mesh file holds.

    Raises
    ------
    ModelError
        If the file cannot be read, or a count in it is not that of what it holds.
    """
    content = bytes_read(path, ModelError)
    with malformed("a mesh"):
        return TEXTS[kind](content) if kind in TEXTS else placed_mesh(path, content)
