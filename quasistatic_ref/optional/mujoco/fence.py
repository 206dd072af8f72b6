"""What an MJCF file may read, checked before MuJoCo sees it, and which element a refusal means.

A model reads from where a URDF may: its own folder, its package or repository, a folder beside its
own that it names; and from the folders that its user names. MuJoCo looks for a file in several
places; each of them at which there is one is checked.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NoReturn
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.files.mesh_files import readable_folders, root_option
from quasistatic_ref.files.urdf.file import LARGEST_FILE
from quasistatic_ref.text.content import bytes_read, text_of

MOST_FILES = 1000
"""Most files of XML of one model."""
FOLDERS = ("assetdir", "meshdir", "texturedir")
"""Attributes of ``compiler`` that say where files are."""
COUNTS = {
    "replicate": ("count",),
    "composite": ("count",),
    "flexcomp": ("count",),
    "hfield": ("nrow", "ncol"),
    "texture": ("width", "height"),
    "numeric": ("size",),
    "user": ("dim",),
    "mesh": ("params",),
}
"""Element -> attributes whose numbers, multiplied, say how much it makes; of ``size`` each does."""
NUMBER = re.compile(r"(\d+\.?\d*(?:e\d+)?)([KMGTPE]?)", re.IGNORECASE)
UNITS = {unit: 2.0 ** (10 * k) for k, unit in enumerate(("", *"KMGTPE"))}
"""Suffixes of memory [bytes]."""


class Fence:
    """The XML of a model, and where its elements stand, so that a refusal can name them.

    Parameters
    ----------
    path : Path
    roots : sequence of str or Path
        Folders from which it may read besides its own.

    Attributes
    ----------
    places : list of (Element, Path, int)
        Each element with its file and line.
    costs : list of (float, Element, str)
        The bytes of each file that an element names, or the numbers that it makes [-], with the
        element and the attribute.

    Raises
    ------
    ModelError
        If the model reads elsewhere, or is no XML: naming file, element and attribute.
    """

    def __init__(self, path: Path, roots: Sequence[str | Path] = ()) -> None:
        self.places: list[tuple[Element, Path, int]] = []
        self.costs: list[tuple[float, Element, str]] = []
        allowed = [folder.resolve() for folder in (path.parent, *map(Path, roots))]
        folders = {path.parent}
        files = [path]
        left = LARGEST_FILE
        for file in files:  # which grows by what each includes
            if len(files) > MOST_FILES:
                raise ModelError(f"consists of more than {MOST_FILES} files; join some", file=path)
            with about_file(file):
                content = bytes_read(file, ModelError, left)
                left -= len(content)
                tree = self._tree(file, text_of(content, file, ModelError))
                folders |= {file.parent}
                folders |= {
                    folder / compiler.get(name, "")
                    for compiler in tree.iter("compiler")
                    for name in FOLDERS
                    for folder in tuple(folders)
                }
                for element, attribute, inside in _files(tree, path.parent, folders, allowed):
                    self.costs.append((inside.stat().st_size, element, attribute))
                    if element.tag in ("include", "model") and inside not in files:
                        files.append(inside)

    def refusal(self, sentence: str) -> ModelError:
        """MuJoCo's sentence, about the element that it means: by its line, or by its name."""
        quoted = re.findall(r"'([^']+)'", sentence)
        words = re.findall(r"\w+", sentence)
        line = re.search(r"Element '(.*)', line (\d+)", sentence)
        error = ModelError(f"MuJoCo refuses it: {' '.join(sentence.split())}")
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
        """MuJoCo's failure, as a sentence about the attribute that asks for most."""
        error = ModelError(f"{problem}; ask for less: copies, meshes, textures, memory")
        costs = [*self.costs, *(cost for element, *_ in self.places for cost in _counts(element))]
        if costs:
            _, element, attribute = max(costs, key=lambda cost: cost[0])
            error = _about(element, attribute, error.problem)
            error.file = next(file for other, file, _ in self.places if other is element)
        return error

    def _tree(self, path: Path, text: str) -> Element:
        builder = TreeBuilder()
        parser = expat.ParserCreate("utf-8")

        def start(tag: str, attributes: dict[str, str]) -> None:
            self.places.append((builder.start(tag, attributes), path, parser.CurrentLineNumber))

        parser.StartElementHandler = start
        parser.EndElementHandler = builder.end
        parser.StartDoctypeDeclHandler = _refuse_doctype
        try:
            parser.Parse(text.encode(), True)
        except expat.ExpatError as error:
            raise ModelError(f"is not XML: {error}") from None
        return builder.close()


def _counts(element: Element) -> Iterator[tuple[float, Element, str]]:
    """How much an element makes by the numbers of its attributes."""
    of_element = [COUNTS[element.tag]] if element.tag in COUNTS else []
    if element.tag == "size":
        of_element = [(attribute,) for attribute in element.attrib]
    for attributes in of_element:
        product = 1.0
        for attribute in attributes:
            for word in element.get(attribute, "").split():
                if number := NUMBER.fullmatch(word):
                    product *= max(float(number[1]) * UNITS[number[2].upper()], 1.0)
        if product > 1:
            yield product, element, attributes[-1]


def _refuse_doctype(*_: object) -> NoReturn:
    raise ModelError("declares a DOCTYPE, which no model needs; remove it", field="DOCTYPE")


def _files(
    tree: Element, home: Path, folders: set[Path], allowed: list[Path]
) -> Iterator[tuple[Element, str, Path]]:
    """Each element and attribute that name a file that is there, and that file, if allowed.

    A folder beside `home` that one of them names is allowed from then on.
    """
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
                    uri = os.path.relpath(place, home)
                    allowed += readable_folders(uri, home.resolve())
                    if not any(inside.is_relative_to(root) for root in allowed):
                        problem = (
                            f"leads to {inside}, outside the folder of the model; move it there, "
                            f"or name its folder: {root_option(value, inside)}"
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
