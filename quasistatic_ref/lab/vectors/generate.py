"""The folder of vectors: what is expected of a case is copied, and of a new case agreed on.

What is copied was made once, and keeps its bytes.
"""

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path

from quasistatic_ref.errors import InputError, QuasistaticError
from quasistatic_ref.lab.vectors.agreed import PROGRAM, agreed_record
from quasistatic_ref.lab.vectors.files import (
    Case,
    answers_written,
    expected_read,
    expected_text,
    inputs_read,
    lines,
)
from quasistatic_ref.lab.vectors.layers import LAYERS, layer
from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.lab.vectors.versions import FORMAT, FORMAT_VERSION, MANIFEST, RELEASE
from quasistatic_ref.simulate.progress import progress_bar
from quasistatic_ref.text.content import bytes_read, bytes_written, text_written, writable_folder

COPIED = ("README.md", "CITATION.cff", "LICENSE*", "inputs/*.json", "schemas/*.json")
"""What is taken over as it is."""


def new_record(name: str, case: Case) -> dict[str, Json]:
    """The expected output of a layer for a new case, as its file stores it.

    Raises
    ------
    InputError
        If package and plain program do not agree on an answer, or the package refuses the case.
    """
    try:
        record = agreed_record(name, case.input) if name in PROGRAM else None
    except QuasistaticError as error:
        raise InputError(f"has no answer: {error}", field=case.id) from error
    if record is None:
        problem = "has no expected answer: the package and the plain program do not agree on one"
        raise InputError(problem, field=case.id)
    return {"id": case.id, **record}


def generate_folder(source: Path, out: Path, progress: bool = True) -> dict[str, int]:
    """Write a folder of vectors: copy known expected outputs, and compute those of new cases.

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
        If an input is bad, or package and plain program do not agree on a new case.
    """
    files = {
        path.relative_to(source).as_posix(): bytes_read(path)
        for pattern in COPIED
        for path in sorted(source.glob(pattern))
    }
    counts = {}
    for name in LAYERS:
        cases = inputs_read(source, name)
        path = f"expected/{name}.json"
        known = expected_read(source, name) if (source / path).exists() else {}
        records = [
            known[case.id] if case.id in known else new_record(name, case)
            for case in progress_bar(cases, words=name, unit="case", shown=progress)
        ]
        files[path] = expected_text(name, records).encode()
        counts[name] = len(cases)
    writable_folder(out)
    for path, content in files.items():
        bytes_written(out / path, content)
    text_written(out / MANIFEST, manifest_text(files))
    return counts


def own_written(source: Path, out: Path, names: Sequence[str], progress: bool = True) -> list[Path]:
    """Write a folder of the package's own float64 answers, as of any other implementation.

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
        cases = progress_bar(inputs_read(source, name), words=name, unit="case", shown=progress)
        outputs = {case.id: layer(name).own(case.input) for case in cases}
        paths.append(answers_written(out, name, f"quasistatic_ref {__version__}", outputs))
    return paths


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
