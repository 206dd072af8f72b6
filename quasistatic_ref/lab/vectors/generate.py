"""The folder of vectors from its inputs, with identical bytes on any machine.

Outputs are computed, or copied where they were made once.
"""

import hashlib
import json
from collections.abc import Iterable, Sequence
from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import bytes_read, bytes_written, text_written, writable_folder
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.files import (
    Case,
    answers_written,
    expected_text,
    inputs_read,
    lines,
)
from quasistatic_ref.lab.vectors.layers import COMPUTED, FILES, LAYERS, layer
from quasistatic_ref.lab.vectors.versions import FORMAT, FORMAT_VERSION, MANIFEST, RELEASE
from quasistatic_ref.simulate.progress import progress_bar

COPIED = (
    "README.md", "CITATION.cff", "LICENSE*", "inputs/*.json", "schemas/*.json",
    *(f"expected/{name}.json" for name in FILES),
)  # fmt: skip
"""What is taken over as it is."""


def expected_record(name: str, case: Case) -> dict[str, Json]:
    """What a layer is expected to answer to a case, as it stands in the file."""
    try:
        return {"id": case.id, **layer(name).expected(case.input).json()}
    except InputError as error:
        error.field = f"{case.id}: {error.field}" if error.field else case.id
        raise


def generate_folder(source: Path, out: Path, progress: bool = True) -> dict[str, int]:
    """Compute or copy every output of the inputs in a folder, and write the whole folder.

    Parameters
    ----------
    source : Path
        A folder of vectors.
    out : Path
        May be the same.
    progress : bool
        Whether to show a progress bar on standard error, where that is a terminal.

    Returns
    -------
    dict of str to int
        Number of cases of each layer.

    Raises
    ------
    InputError
        If an input is bad, or answers that are copied are not there.
    """
    counts = {name: len(inputs_read(source, name)) for name in LAYERS}
    for name in FILES:
        answers = source / "expected" / f"{name}.json"
        if not answers.exists():
            problem = "is missing: the answers of this layer are a file, which is copied"
            raise InputError(problem, file=answers)
    writable_folder(out)
    files = {
        path.relative_to(source).as_posix(): bytes_read(path)
        for pattern in COPIED
        for path in sorted(source.glob(pattern))
    }
    for name in COMPUTED:
        cases = inputs_read(source, name)
        records = [expected_record(name, case) for case in _with_progress(cases, name, progress)]
        files[f"expected/{name}.json"] = expected_text(name, records).encode()
    for path, content in files.items():
        bytes_written(out / path, content)
    text_written(out / MANIFEST, manifest_text(files))
    return counts


def own_written(source: Path, out: Path, names: Sequence[str], progress: bool = True) -> list[Path]:
    """Write the package's own float64 answers, as anybody else's: a folder of answers.

    Parameters
    ----------
    source : Path
        A folder of vectors.
    out : Path
    names : sequence of str
        Layers.
    progress : bool
    """
    from quasistatic_ref import __version__

    writable_folder(out)
    paths = []
    for name in names:
        cases = _with_progress(inputs_read(source, name), name, progress)
        outputs = {case.id: layer(name).own(case.input) for case in cases}
        paths.append(answers_written(out, name, f"quasistatic_ref {__version__}", outputs))
    return paths


def _with_progress(cases: list[Case], name: str, progress: bool) -> Iterable[Case]:
    bar: Iterable[Case] = progress_bar(cases, words=name, unit="case", shown=progress)
    return bar


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
    record: dict[str, Json] = {"format": FORMAT, "version": FORMAT_VERSION, "release": RELEASE}
    return lines({**record, "cases": cases, "files": listed}, listed=("files",))
