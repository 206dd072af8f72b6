"""One archive of the vectors, fit to be kept: the same bytes on any machine.

It holds the folder as its manifest lists it, and the list of hashes as ``sha256sum --check`` reads
it. Files are stored and not compressed, as compressors differ from one version to the next.
"""

import hashlib
import io
import zipfile
from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import bytes_read, bytes_written, text_written, writable_folder
from quasistatic_ref.lab.vectors.versions import MANIFEST, edition, manifest

EPOCH = (1980, 1, 1, 0, 0, 0)
"""The time of every member: the earliest that a zip file knows."""
SUMS = "SHA256SUMS"


def write_zip(vectors: Path, out: Path) -> tuple[Path, str]:
    """Write ``quasi-dynamic-vectors-N.zip``, and next to it its SHA-256; return both.

    Parameters
    ----------
    vectors : Path
        A folder of vectors.
    out : Path

    Raises
    ------
    InputError
        If a file is not as the manifest has it, or a layer not as the version froze it.
    """
    release, listed = manifest(vectors)
    found = edition(vectors)
    if found.changed:
        problem = f"is not as version {release} has it; other cases are another version"
        raise InputError(problem, file=vectors, field=found.changed[0])
    name = found.name.replace(" ", "-")
    files = {MANIFEST: bytes_read(vectors / MANIFEST)}
    for path, code in listed.items():
        files[path] = bytes_read(vectors / path)
        if _hash(files[path]) != code:
            raise InputError("is another file than its manifest says", file=vectors / path)
    sums = "".join(f"{_hash(content)}  {path}\n" for path, content in sorted(files.items()))
    content = _archive({SUMS: sums.encode(), **files}, name)
    archive = bytes_written(writable_folder(out) / f"{name}.zip", content)
    text_written(out / f"{name}.zip.sha256", f"{_hash(content)}  {archive.name}\n")
    return archive, _hash(content)


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _archive(files: dict[str, bytes], folder: str) -> bytes:
    """The archive: members in the order of their names, of one time and one mode."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED) as archive:
        for path, content in sorted(files.items()):
            member = zipfile.ZipInfo(f"{folder}/{path}", EPOCH)
            member.create_system = 3  # Unix, on any machine
            member.external_attr = 0o100644 << 16
            archive.writestr(member, content)
    return stream.getvalue()
