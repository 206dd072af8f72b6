"""Engines side by side: ``python -m validation.make.engines [NAME ...]``.

Makes one environment of Python 3.11 with the pinned engines and this project (in a temporary
folder; ``--environment`` keeps it in a folder of yours, and takes what is there), asks each engine,
or those named, in a process of its own, and writes ``NAME.json`` and the page phenomena.md.
``--tables`` only writes the page, from the committed results. An engine that is missing, or ends in
the middle, and a cell without an answer, such as a state that is no number, are named in a sentence
each; the others are asked, and the exit status is 2.
"""

import json
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from quasistatic_ref.text.content import text_written
from validation.programs.engines.table import page
from validation.tools.scripts import RESULTS, ROOT, environment, record_written, script_options

ENGINES = ("quasistatic", "bullet", "dart", "drake", "mujoco")
"""Modules of validation/programs/engines, the slowest first."""
COMMITTED = ("newton", "pinocchio")
"""Engines whose results were measured once; their adapters are gone."""
PYTHON = (3, 11)
"""The only one for which pybullet has wheels and that this project runs on."""
TIMEOUT = 1800.0
"""For one engine [s]."""


def answers(name: str, python: Path | str) -> dict[str, Any]:
    """What an engine answered.

    Raises
    ------
    RuntimeError
        If it is missing or ended before its last answer; the sentence says which.
    """
    command = [str(python), "-m", "validation.programs.engines.ask", name]
    print(f"{name}: asked", file=sys.stderr, flush=True)
    try:
        process = subprocess.run(
            command, cwd=ROOT, text=True, capture_output=True, timeout=TIMEOUT, check=False
        )
    except subprocess.TimeoutExpired:
        raise RuntimeError(f"{name}: no answer within {TIMEOUT:g} s") from None
    lines = [json.loads(line) for line in process.stdout.splitlines()]
    if not lines or process.returncode:
        missing = lines[0].get("missing") if lines else None
        end = f"is not installed ({missing})" if missing else f"ended with {process.returncode}"
        raise RuntimeError(f"{name}: {end}")
    head, *cells = lines
    return {**head, "cells": cells}


def asked(names: tuple[str, ...], python: Path | str, results: Path) -> int:
    """Ask engines, two at a time, and write what they answered; how many did not."""
    failures = 0
    with ThreadPoolExecutor(2) as pool:
        replies = {name: pool.submit(answers, name, python) for name in names}
        for name, reply in replies.items():
            try:
                record = reply.result()
            except RuntimeError as error:
                sentences = [str(error)]
            else:
                record_written(results / f"{name}.json", record)
                sentences = unanswered(name, record)
            failures += len(sentences)
            print(*sentences, sep="\n", end="\n" if sentences else "", file=sys.stderr)
    return failures


def unanswered(name: str, record: dict[str, Any]) -> list[str]:
    """A sentence for each cell to which an engine came to no answer."""
    return [
        f"{name}, {cell['setting']}, {cell['phenomenon']}: {cell['failed']}"
        for cell in record["cells"]
        if "failed" in cell
    ]


def records(results: Path) -> dict[str, dict[str, Any]]:
    """Results that are there, by engine."""
    return {
        name: json.loads(path.read_text("utf-8"))
        for name in (*ENGINES, *COMMITTED)
        if (path := results / f"{name}.json").exists()
    }


def main() -> int:
    """Ask, and write the page."""
    options = script_options(
        __doc__, ENGINES, out=RESULTS / "engines", environment=Path, tables=False
    )
    if not options.tables and sys.version_info[:2] != PYTHON:
        print("engines: needs Python 3.11, for which pybullet has wheels", file=sys.stderr)
        return 2
    options.out.mkdir(parents=True, exist_ok=True)
    failures = 0
    if not options.tables:
        with tempfile.TemporaryDirectory() as temporary:
            home = (options.environment or Path(temporary) / "engines").absolute()
            python = environment(home, "-e", f"{ROOT}[compared]")
            failures = asked(tuple(options.names or ENGINES), python, options.out)
    text_written(options.out / "phenomena.md", page(records(options.out)))
    return 2 if failures else 0


if __name__ == "__main__":
    raise SystemExit(main())
