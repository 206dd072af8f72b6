"""COLLADA files, checked before a mesh library reads them.

Assimp, which coal loads meshes with, takes an index that is no number for one and asks for the
memory that it seems to need: one letter in a file of 920 bytes takes all of a machine's. It drops
a triangle with a negative index without a word. So indices and counts are looked at first.
"""

from pathlib import Path

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.formats.files import bytes_read, text_of
from quasistatic_ref.model.readers.mesh_files import CHECK_DAE
from quasistatic_ref.model.urdf.urdf_xml import xml_root

INDICES = ("p", "v", "h", "vcount")
"""Elements whose text is a list of indices, or of numbers of corners."""
COUNTS = ("count", "offset", "stride")
"""Attributes by which memory is allocated: none is larger than the words of the file."""


def check_dae(path: Path) -> None:
    """Refuse a COLLADA file with an index or a count that cannot be one.

    Raises
    ------
    ModelError
        If it is not XML, an index is no whole number >= 0, or a count is larger than what the
        whole file holds.
    """
    text = text_of(bytes_read(path, ModelError), path, ModelError)
    with about_file(path):
        root = xml_root(text)
        most = len(text.split())
        for element in root.iter():
            tag = element.tag.rpartition("}")[2].rpartition(":")[2]
            if tag in INDICES:
                for word in (element.text or "").split():
                    _check(word, 2**31 - 1, f"<{tag}>")
            for name in COUNTS:
                if name in element.attrib:
                    _check(element.attrib[name].strip(), most, f"<{tag} {name}>")


def _check(word: str, most: int, where: str) -> None:
    if not (word.isascii() and word.isdecimal() and len(word) < 20):
        raise ModelError("must be a whole number, 0 or more", field=where, value=word)
    if int(word) > most:
        problem = f"is larger than {most}, which is all there can be"
        raise ModelError(problem, field=where, value=word)


CHECK_DAE.fill(check_dae)
