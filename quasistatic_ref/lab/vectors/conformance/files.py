"""``vectors report``: what an implementation passed, as a page, a badge and a record."""

import hashlib
import json
import platform
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from quasistatic_ref import __version__
from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import bytes_read, text_written, writable_folder
from quasistatic_ref.lab.page.html import html_page
from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.page.parts import Table
from quasistatic_ref.lab.vectors.check.answers import Answers, answers_read
from quasistatic_ref.lab.vectors.check.folder import check_answers
from quasistatic_ref.lab.vectors.check.scope import WHOLE, Scope
from quasistatic_ref.lab.vectors.conformance.badge import badge
from quasistatic_ref.lab.vectors.conformance.conformance import Conformance
from quasistatic_ref.lab.vectors.conformance.page import page
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.versions import edition

FORMAT = "quasistatic-ref/vectors-conformance"
LONGEST = 80
"""Characters of the name of an implementation."""


def conformance(
    answers: Path,
    vectors: Path,
    implementation: str | None = None,
    digits: float | None = None,
    scope: Scope = WHOLE,
) -> Conformance:
    """What a folder of answers passed, of all layers.

    Parameters
    ----------
    answers, vectors : Path
        Folders.
    implementation : str, optional
        Its name; by default as the answers name themselves.
    digits : float, optional
        [-] An answer that is right to so many digits is acceptable.
    scope : Scope
        What it says that it does.

    Raises
    ------
    InputError
        As `check_answers` does, and of a name that is none.
    """
    report = check_answers(answers, vectors, digits=digits, scope=scope)
    names = dict.fromkeys(layer.implementation for layer in report.layers if layer.implementation)
    name = implementation if implementation is not None else " and ".join(names)
    name = name.strip()
    if not name or len(name) > LONGEST or not name.isprintable():
        problem = f"must be a name of 1 to {LONGEST} characters on one line"
        raise InputError(problem, field="--implementation", value=name)
    return Conformance(name, report, edition(vectors))


def written(found: Conformance, answers: Path, out: Path) -> list[Path]:
    """Write ``report.html``, ``report.md``, ``badge.svg`` and ``report.json``.

    Parameters
    ----------
    found : Conformance
    answers, out : Path
        Folders.
    """
    writable_folder(out)
    declared = {one.layer: answers_read(answers, one.layer) for one in found.answered}
    contents = {name: bytes_read(answers / f"{name}.json") for name in declared}
    hashes = {name: hashlib.sha256(content).hexdigest() for name, content in contents.items()}
    image = badge(found)
    content = page(found, declared, _versions(found, declared, hashes))
    record = json.dumps(record_of(found, hashes), indent=1) + "\n"
    files = {
        "report.html": html_page(content, {"badge": image.encode()}),
        "report.md": markdown_page(content),
        "badge.svg": image,
        "report.json": record,
    }
    return [text_written(out / name, text) for name, text in files.items()]


def record_of(found: Conformance, hashes: Mapping[str, str]) -> dict[str, Json]:
    """The same as JSON.

    Parameters
    ----------
    found : Conformance
    hashes : mapping of str to str
        SHA-256 of each file of answers.
    """
    layers = [
        {**one.record, "answers_sha256": hashes.get(one.layer), "in_part": one.in_part,
         "to_fewer_digits": one.loose, "frozen": one.layer not in found.edition.changed,
         "vectors_sha256": found.edition.hashes[one.layer]}
        for one in found.layers
    ]  # fmt: skip
    return {
        "format": FORMAT,
        "version": 1,
        "implementation": found.implementation,
        "vectors": found.edition.release,
        "judge": f"quasistatic_ref {__version__}",
        "digits": found.report.digits,
        "scope": found.report.record["scope"],
        "ok": found.report.ok,
        "label": found.label,
        "message": found.message,
        "layers": layers,
    }


def _on_one_line(name: str) -> str:
    """A name as it stands in a table, whatever characters it has."""
    shown = "".join(c if c.isprintable() else " " for c in name)
    return " ".join(shown.split())[:LONGEST] or "-"


def _versions(
    found: Conformance, declared: Mapping[str, Answers], hashes: Mapping[str, str]
) -> tuple[Table, ...]:
    """Tables of versions and hashes."""
    names = {layer: answers.implementation for layer, answers in declared.items()}
    own = [
        (f"name in the answers to {', '.join(layer for layer in names if names[layer] == name)}",
         _on_one_line(name))
        for name in dict.fromkeys(names.values())
    ]  # fmt: skip
    versions = (
        ("implementation", found.implementation),
        *((("scope", found.report.scope.name),) if found.report.scope else ()),
        *own,
        ("vectors", found.edition.name),
        ("judge", f"quasistatic_ref {__version__}"),
        ("Python and NumPy of the judge", f"{platform.python_version()}, {np.__version__}"),
    )
    kept = {True: f"changed, not {found.edition.name}", False: f"as {found.edition.name} has it"}
    layers = tuple(
        (layer, kept[layer in found.edition.changed], f"`{found.edition.hashes[layer]}`")
        for layer in declared
    )
    files = tuple((f"{layer}.json", f"`{code}`") for layer, code in hashes.items())
    return (
        Table("Versions", "", ("what", "which"), versions, 2),
        Table("Cases and expected outputs", "", ("layer", "its cases", "SHA-256"), layers, 3),
        Table("Answers", "", ("file", "SHA-256"), files, 2),
    )
