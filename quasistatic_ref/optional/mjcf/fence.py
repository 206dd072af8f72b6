"""What an MJCF file may read and how much it may ask for, checked before MuJoCo sees it.

A model reads only from its own folder, and from the folders that its user names. MuJoCo looks for a
file in several places; each of them at which there is one is checked.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from xml.etree import ElementTree

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.formats.files import LARGEST_TEXT, bytes_read, text_of

MOST_FILES = 1000
"""Most files of XML of one model."""
MOST_COPIES = 10_000
"""Most copies by nested replicas, and most parts of a composite."""
MOST_NUMBERS = 4_000_000
"""Most numbers of a height field, points of a texture, or entries of a buffer."""
_FOLDERS = ("assetdir", "meshdir", "texturedir")
"""Attributes of ``compiler`` that say where files are."""
_COUNTED = {
    "composite": ("count", MOST_COPIES),
    "flexcomp": ("count", MOST_COPIES),
    "hfield": ("nrow", "ncol", MOST_NUMBERS),
    "texture": ("width", "height", MOST_NUMBERS),
    "mesh": ("params", MOST_NUMBERS // 4),
}
"""Element -> attributes of which the product of all numbers is bounded, and the bound."""


def check_model(path: Path, roots: Sequence[str | Path] = ()) -> None:
    """Refuse a model that reads elsewhere, or asks for more than any robot has.

    Parameters
    ----------
    path : Path
    roots : sequence of str or Path
        Folders from which it may read besides its own.

    Raises
    ------
    ModelError
        Naming file, element and attribute.
    """
    allowed = [folder.resolve() for folder in (path.parent, *map(Path, roots))]
    folders = {path.parent}
    found = [path]
    for file in found:  # which grows by what each includes
        if len(found) > MOST_FILES:
            raise ModelError(f"consists of more than {MOST_FILES} files", file=path)
        with about_file(file):
            tree = _tree(file)
            folders |= {file.parent}
            folders |= {
                folder / compiler.get(name, "")
                for compiler in tree.iter("compiler")
                for name in _FOLDERS
                for folder in tuple(folders)
            }
            _check_sizes(tree)
            for element, inside in _files(tree, folders, allowed):
                if element.tag in ("include", "model") and inside not in found:
                    found.append(inside)


def _tree(path: Path) -> ElementTree.Element:
    text = text_of(bytes_read(path, ModelError, LARGEST_TEXT), path, ModelError)
    if "<!DOCTYPE" in text.upper():
        raise ModelError("declares a DOCTYPE, which no model needs; remove it")
    try:
        return ElementTree.fromstring(text)
    except (ElementTree.ParseError, ValueError) as error:
        raise ModelError(f"is not XML: {error}") from None


def _files(
    tree: ElementTree.Element, folders: set[Path], allowed: Sequence[Path]
) -> Iterator[tuple[ElementTree.Element, Path]]:
    """Each element that names a file that is there, with that; ModelError if it lies elsewhere."""
    for element in tree.iter():
        for attribute, value in element.attrib.items():
            if not attribute.startswith("file"):
                continue
            for folder in sorted(folders):
                for name in (value, Path(value).name):  # strippath
                    place = folder / name
                    try:
                        if not place.exists():
                            continue
                        inside = place.resolve()
                    except (OSError, ValueError, RuntimeError):
                        raise _about(element, attribute, "cannot be a path") from None
                    if not any(inside.is_relative_to(root) for root in allowed):
                        problem = (
                            f"leads to {inside}, outside the folder of the model; move it there, "
                            "or name its folder in package_dirs (in Python: roots)"
                        )
                        raise _about(element, attribute, problem)
                    if not inside.is_file():
                        if name:
                            raise _about(element, attribute, "is a folder, a device or a pipe")
                        continue
                    yield element, inside


def _check_sizes(tree: ElementTree.Element) -> None:
    front = [(tree, 1.0)]
    for element, copies in front:
        inner = copies
        if element.tag == "replicate":
            inner *= _product(element, "count")
            if not inner <= MOST_COPIES:
                raise _about(element, "count", f"makes more than {MOST_COPIES} copies")
        if element.tag == "size":
            for attribute in element.attrib:
                if attribute != "memory" and not _product(element, attribute) <= MOST_NUMBERS:
                    raise _about(element, attribute, f"must be at most {MOST_NUMBERS}")
        if element.tag in _COUNTED:
            *attributes, most = _COUNTED[element.tag]
            product = 1.0
            for attribute in map(str, attributes):
                product *= _product(element, attribute)
                if not product <= float(most):
                    raise _about(element, attribute, f"makes more than {most} parts or numbers")
        front.extend((child, inner) for child in element)


def _product(element: ElementTree.Element, attribute: str) -> float:
    """The product of the sizes of an attribute's numbers, each at least 1."""
    product = 1.0
    for word in element.get(attribute, "").split():
        try:
            product *= max(abs(float(word)), 1.0)
        except ValueError:
            continue  # MuJoCo says what is wrong with it
    return product


def _about(element: ElementTree.Element, attribute: str, problem: str) -> ModelError:
    name = element.get("name")
    where = f"{element.tag}[{name}]" if name else element.tag
    return ModelError(problem, field=f"{where}.{attribute}", value=element.get(attribute))
