"""Where the files that a scenario names may be.

A path in a scenario file is relative to the file's folder and leads to a file inside it, symbolic
links followed: a scenario of another author reads only what came with it. A path given by
``--set`` is the user's own, and may lead anywhere. Robots and clouds may lie in the user's roots,
too, the folders of ``--root``.

``package://NAME/PATH`` is a file of an installed Python package that keeps robots, as those of
PyPI's ``example-robot-data`` do: in ``cmeel.prefix/share/NAME``, next to the modules of Python.
"""

import sys
from collections.abc import Sequence
from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.files.mesh_files import PACKAGE
from quasistatic_ref.model.tree import Tree
from quasistatic_ref.quoting import slash_remedy
from quasistatic_ref.text.table_reader import TableReader

SHARED = Path("cmeel.prefix", "share")
"""Where installed packages keep robots, next to the modules of Python."""


def path_in(
    folder: Path, table: TableReader, field: str, roots: Sequence[Path] = ()
) -> Path | None:
    """The path in one field, or None where there is no such field.

    It leads into the folder, or into one of the `roots`.

    Raises
    ------
    ScenarioError
        If there is no such file, it leads out of the folder, cannot be a path, or names a package
        or a file of one that is not installed.
    """
    text = table.text(field, None)
    setting = f"--set {table.name(field)}=PATH"
    remedy = f"move the file there, or give the path on the command line, as {setting}"
    if text is None:
        return None
    path = _path(folder, table, field, text, remedy, roots)
    if not path.exists():
        problem = "names no file; a path begins at the scenario's folder"
        raise table.error_about(field, problem + slash_remedy(text), text)
    return path


def folders_in(folder: Path, table: TableReader, field: str, names: Sequence[str]) -> list[Path]:
    """The paths of a list in one field, as `path_in` has one; ScenarioError if one is no folder."""
    remedy = "name it on the command line, as --root FOLDER"
    folders = [_path(folder, table, field, name, remedy) for name in names]
    for path, name in zip(folders, names, strict=True):
        if not path.is_dir():
            raise table.error_about(field, "is no folder" + slash_remedy(name), name)
    return folders


def _path(
    folder: Path,
    table: TableReader,
    field: str,
    text: str,
    remedy: str,
    roots: Sequence[Path] = (),
) -> Path:
    if not text.strip():
        raise table.error_about(field, "must name a file", text)
    path = folder / text
    try:
        if text.startswith(PACKAGE):
            return _installed(table, field, text)
        inside = table.is_of_user(field) or lies_in(path, [folder, *roots])
    except InputError:
        raise
    except (ValueError, RuntimeError, OSError):  # a NUL character; links in a circle
        raise table.error_about(field, "cannot be a path", text) from None
    if not inside:
        raise table.error_about(field, f"is outside the scenario's folder; {remedy}", text)
    return path


def lies_in(path: Path, folders: Sequence[Path]) -> bool:
    """Whether a path leads into one of some folders, symbolic links followed."""
    resolved = path.resolve()
    return any(resolved.is_relative_to(folder.resolve()) for folder in folders)


def inline_urdf(table: TableReader, field: str) -> str | Tree | None:
    """The URDF that stands in the field itself, a text from ``<`` on or a mechanism.

    None of anything else.

    Only of the user's own words: the meshes of a text are looked for in the working folder.
    """
    text = table.peek(field)
    if isinstance(text, Tree):
        table.take(field)
        return text
    is_text = isinstance(text, str) and text.lstrip().startswith("<") and table.is_of_user(field)
    return str(table.take(field)) if is_text else None


def shared_folders(path: Path) -> list[Path]:
    """Folders of installed packages that a file lies in: where its own ``package://`` is sought."""
    return [folder for folder in _shared() if path.is_relative_to(folder)]


def _shared() -> list[Path]:
    return [Path(place) / SHARED for place in dict.fromkeys(sys.path)]


def _installed(table: TableReader, field: str, text: str) -> Path:
    name, _, inside = text.removeprefix(PACKAGE).partition("/")
    for shared in _shared():
        path = shared / name / inside
        package = (shared / name).resolve()
        if path.is_file() and package.parent == shared.resolve():
            if path.resolve().is_relative_to(package):
                return path
            raise table.error_about(field, "must be a path inside the package", text)
    remedy = "to install the robots, run pip install 'quasistatic-ref[robots]'"
    raise table.error_about(field, f"is not a file of an installed package; {remedy}", text)
