"""``vectors report`` and ``vectors pack``: what was passed, and of which vectors."""

import argparse
import sys
from pathlib import Path

from quasistatic_ref.cli import options as shared
from quasistatic_ref.formats.files import json_read
from quasistatic_ref.lab.folders import vectors_folder


def vectors_given(options: argparse.Namespace) -> Path:
    """The folder of vectors of ``--vectors``; by default that which comes along."""
    folder: Path | None = options.vectors
    return vectors_folder() if folder is None else folder


def run_report(options: argparse.Namespace) -> int:
    """Write the page, the badge and the record; 1 if anything failed, as ``vectors check``."""
    from quasistatic_ref.lab.vectors.check.scope import scope_read
    from quasistatic_ref.lab.vectors.conformance.files import conformance, written

    found = conformance(
        options.answers, vectors_given(options), options.implementation, options.digits,
        scope_read(options.scope),
    )  # fmt: skip
    paths = written(found, options.answers, options.out)
    if options.json:
        shared.print_json(json_read(paths[-1]))
        return found.report.status
    if not options.quiet:
        print(f"{found.label}: {found.message}")
        for path in paths:
            print(f"wrote {path}")
    for layer in found.report.layers:
        if not layer.ok:
            print(f"quasistatic-ref: {layer.layer}: {layer.trouble}", file=sys.stderr)
    return found.report.status


def run_pack(options: argparse.Namespace) -> int:
    """Write the archive, and its hash."""
    from quasistatic_ref.lab.vectors.pack import packed

    path, code = packed(vectors_given(options), options.out)
    if not options.quiet:
        print(f"wrote {path}")
        print(f"SHA-256 {code}")
    return 0
