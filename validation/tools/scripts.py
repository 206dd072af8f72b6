"""What scripts share that make a committed result: their options, and their page."""

import argparse
import json
import subprocess
import sys
from collections.abc import Collection
from pathlib import Path
from typing import Any

from quasistatic_ref.text.content import text_written
from quasistatic_ref.text.json_text import plain

ROOT = Path(__file__).parents[2]
"""Of the checkout."""
RESULTS = ROOT / "validation" / "results"


def script_options(
    doc: str | None, names: Collection[str] = (), **options: Any
) -> argparse.Namespace:
    """The options that a script was called with; its docstring is its help.

    Parameters
    ----------
    doc : str
        What each option is for stands there.
    names : collection of str
        Words that may stand without a dash; ``names`` of the result, empty for none of them.
    options
        Name -> default, or the type of an option that is None by default. False: a switch.
    """
    form = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=doc, formatter_class=form)
    if names:
        parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(names))
    for name, default in options.items():
        if default is False:
            parser.add_argument(f"--{name}", action="store_true")
        elif isinstance(default, type):
            parser.add_argument(f"--{name}", type=default)
        else:
            parser.add_argument(f"--{name}", type=type(default), default=default)
    chosen = parser.parse_args()
    if unknown := set(chosen.names if names else ()) - set(names):
        parser.error(f"no such name: {', '.join(sorted(unknown))}; there are {', '.join(names)}")
    return chosen


def record_written(path: Path, record: Any) -> None:
    """Write a record of numbers and arrays as JSON, a field a line; infinite ones as Infinity."""
    text_written(path, json.dumps(plain(record), indent=1) + "\n")


def environment(home: Path, *wanted: str, python: str = sys.executable) -> Path:
    """The interpreter of an environment in a folder, made unless it is there.

    Parameters
    ----------
    home : Path
    *wanted : str
        What pip installs into it.
    python : str
        The interpreter that it is made with.
    """
    interpreter = home / "bin" / "python"
    if not interpreter.exists():
        subprocess.run([python, "-m", "venv", str(home)], check=True)
        if wanted:
            subprocess.run([str(interpreter), "-m", "pip", "install", "-q", *wanted], check=True)
    return interpreter
