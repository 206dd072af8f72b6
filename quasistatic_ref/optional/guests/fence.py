"""What an MJCF file may read and how much it may ask for, checked before MuJoCo sees it.

A model reads only from its own folder, and from the folders that its user names. MuJoCo looks for a
file in several places; each of them at which there is one is checked.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NoReturn
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.formats.files import bytes_read, text_of
from quasistatic_ref.model.urdf.urdf_file import LARGEST_FILE, MOST_LINKS

MOST_FILES = 1000
"""Most files of XML of one model."""
DEEPEST = 300
"""Most elements that are nested; MuJoCo's XML reader ends at 500."""
MOST_COPIES = MOST_LINKS
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
    "numeric": ("size", MOST_NUMBERS),
    "user": ("dim", MOST_NUMBERS),
}
"""Element -> attributes of which the product of all numbers is bounded, and the bound."""
RESOLUTIONS = {"wedge": 2, "plate": 2}
"""Built-in meshes whose corners are a grid of their first two parameters, or that many squared."""


@dataclass
class Fence:
    """A model, and where its elements stand, so that a refusal can name them.

    Parameters
    ----------
    path : Path
    roots : sequence of str or Path
        Folders from which it may read besides its own.

    Attributes
    ----------
    read : int
        Bytes of XML that were read.
    bodies : int
        Elements of that name.
    places : list of (Element, Path, int)
        Each element with its file and line.
    costs : list of (float, Element, str)
        The bytes of each file that an element names, or the numbers that it asks for [-], with the
        element and the attribute.

    Raises
    ------
    ModelError
        If the model reads elsewhere, or asks for more than any robot has: naming file, element and
        attribute.
    """

    path: Path
    roots: Sequence[str | Path] = ()
    read: int = 0
    bodies: int = 0
    places: list[tuple[Element, Path, int]] = field(default_factory=list)
    costs: list[tuple[float, Element, str]] = field(default_factory=list)

    def __post_init__(self) -> None:
        allowed = [folder.resolve() for folder in (self.path.parent, *map(Path, self.roots))]
        folders = {self.path.parent}
        found = [self.path]
        for file in found:  # which grows by what each includes
            if len(found) > MOST_FILES:
                raise ModelError(f"consists of more than {MOST_FILES} files", file=self.path)
            with about_file(file):
                tree = self._tree(file)
                folders |= {file.parent}
                folders |= {
                    folder / compiler.get(name, "")
                    for compiler in tree.iter("compiler")
                    for name in _FOLDERS
                    for folder in tuple(folders)
                }
                self._check_sizes(tree)
                for element, attribute, inside in _files(tree, folders, allowed):
                    self.costs.append((inside.stat().st_size, element, attribute))
                    if element.tag in ("include", "model") and inside not in found:
                        found.append(inside)

    def refusal(self, said: str) -> ModelError:
        """What MuJoCo says, about the element that it means: by its line, or by its name."""
        quoted = re.findall(r"'([^']+)'", said)
        words = re.findall(r"\w+", said)
        line = re.search(r"Element '(.*)', line (\d+)", said)
        error = ModelError(f"MuJoCo refuses it: {' '.join(said.split())}")
        best = 0
        for element, file, number in self.places:
            marked = [a for a in element.attrib if a in words and a != "name"]
            marked += [a for a, value in element.attrib.items() if value in quoted]
            at = line is not None and (element.tag, str(number)) == line.groups()
            named = element.get("name") in quoted
            score = 8 * at + 4 * named + 2 * (element.tag in words) + bool(marked)
            if score > best and (at or marked):
                best = score
                error.field = _named(element, *marked[:1])
                error.file = file
        return error

    def too_much(self, problem: str) -> ModelError:
        """What MuJoCo could not do, about the attribute that asks for most."""
        error = ModelError(f"{problem}; give it fewer copies, or smaller meshes and textures")
        if self.costs:
            _, element, attribute = max(self.costs, key=lambda cost: cost[0])
            error = _about(element, attribute, error.problem)
            error.file = next(file for other, file, _ in self.places if other is element)
        return error

    def _tree(self, path: Path) -> Element:
        content = bytes_read(path, ModelError, LARGEST_FILE)
        self.read += len(content)
        if self.read > LARGEST_FILE:
            raise ModelError(f"makes the model larger than {LARGEST_FILE / 2**20:g} MiB of XML")
        text = text_of(content, path, ModelError)
        builder = TreeBuilder()
        parser = expat.ParserCreate("utf-8")
        open_: list[Element] = []

        def start(tag: str, attributes: dict[str, str]) -> None:
            element = builder.start(tag, attributes)
            open_.append(element)
            self.places.append((element, path, parser.CurrentLineNumber))
            self.bodies += tag == "body"
            if len(open_) > DEEPEST:
                raise ModelError(f"is nested deeper than {DEEPEST} elements", field=_named(element))
            if self.bodies > MOST_LINKS:
                raise ModelError(f"is one of more than {MOST_LINKS} bodies", field=_named(element))

        def end(tag: str) -> None:
            builder.end(tag)
            open_.pop()

        parser.StartElementHandler = start
        parser.EndElementHandler = end
        parser.StartDoctypeDeclHandler = _refuse_doctype
        try:
            parser.Parse(text.encode(), True)
        except expat.ExpatError as error:
            raise ModelError(f"is not XML: {error}") from None
        return builder.close()

    def _check_sizes(self, tree: Element) -> None:
        front = [(tree, 1.0)]
        for element, copies in front:
            inner = copies
            if element.tag == "replicate":
                inner *= self._product(element, "count")
                if not inner <= MOST_COPIES:
                    raise _about(element, "count", f"makes more than {MOST_COPIES} copies")
            if element.tag == "size":
                for attribute in element.attrib:
                    if attribute != "memory":
                        asked = self._product(element, attribute)
                        if not asked <= MOST_NUMBERS:
                            raise _about(element, attribute, f"must be at most {MOST_NUMBERS}")
            if element.tag == "mesh":
                corners = self._corners(element)
                if not corners <= MOST_NUMBERS // 4:
                    problem = f"makes {corners:g} corners, more than {MOST_NUMBERS // 4}"
                    raise _about(element, "params", problem)
            if element.tag in _COUNTED:
                *attributes, most = _COUNTED[element.tag]
                product = 1.0
                for attribute in map(str, attributes):
                    product *= self._product(element, attribute)
                    if not product <= float(most):
                        problem = f"makes more than {most} parts or numbers"
                        raise _about(element, attribute, problem)
            front.extend((child, inner) for child in element)

    def _corners(self, element: Element) -> float:
        """Corners of a built-in mesh, by its resolutions; its other parameters are lengths."""
        words = element.get("params", "").split()
        count = RESOLUTIONS.get(element.get("builtin", ""), 1)
        try:
            sizes = [max(abs(float(word)), 1.0) for word in words[:count]]
        except ValueError:
            return 0.0  # MuJoCo says what is wrong with it
        product = math.prod(sizes) ** (2 if count == 1 else 1)
        if product > 1:
            self.costs.append((product, element, "params"))
        return product

    def _product(self, element: Element, attribute: str) -> float:
        """The product of the sizes of an attribute's numbers, each at least 1."""
        product = 1.0
        for word in element.get(attribute, "").split():
            try:
                product *= max(abs(float(word)), 1.0)
            except ValueError:
                continue  # MuJoCo says what is wrong with it
        if product > 1:
            self.costs.append((product, element, attribute))
        return product


def _refuse_doctype(*_: object) -> NoReturn:
    raise ModelError("declares a DOCTYPE, which no model needs; remove it", field="DOCTYPE")


def _files(
    tree: Element, folders: set[Path], allowed: Sequence[Path]
) -> Iterator[tuple[Element, str, Path]]:
    """Each element and attribute that name a file that is there, and that file, if allowed."""
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
                            "or name its folder: --root FOLDER"
                        )
                        raise _about(element, attribute, problem)
                    if not inside.is_file():
                        if name:
                            raise _about(element, attribute, "is a folder, a device or a pipe")
                        continue
                    yield element, attribute, inside


def _about(element: Element, attribute: str, problem: str) -> ModelError:
    return ModelError(problem, field=_named(element, attribute), value=element.get(attribute))


def _named(element: Element, *attribute: str) -> str:
    name = element.get("name")
    where = f"{element.tag}[{name}]" if name else element.tag
    return ".".join((where, *attribute))
