"""``completion SHELL``: a script by which a shell completes the arguments of this program."""

import argparse
import re
from pathlib import Path
from typing import Any

import shtab

from quasistatic_ref.cli.options import COMPLETED

SHELLS = ("bash", "zsh", "fish")
FOLDERS = ("FOLDER", "ANSWERS")
"""What an argument is called that is a folder."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument("shell", choices=SHELLS, help="the shell that is to read the script")


def run(options: argparse.Namespace) -> int:
    """Print the script."""
    from quasistatic_ref.cli.main import COMMANDS, command_parser

    parser = command_parser(COMMANDS)
    _prepare(parser)
    print(shtab.complete(parser, options.shell))
    return 0


def _prepare(parser: argparse.ArgumentParser) -> None:
    """Tell shtab what each argument is completed by."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for inner in action.choices.values():
                _prepare(inner)
        elif (declared := getattr(action, COMPLETED, None)) is not None:
            words, files = declared
            complete = _words_and_files(f"{parser.prog} {action.dest}", list(words()), files)
            action.complete = complete  # type: ignore[attr-defined]  # read by shtab, unknown to argparse
        elif action.type is Path:
            complete = shtab.DIRECTORY if action.metavar in FOLDERS else shtab.FILE
            action.complete = complete  # type: ignore[attr-defined]  # read by shtab, unknown to argparse


def _words_and_files(argument: str, words: list[str], files: tuple[str, ...]) -> dict[str, Any]:
    """How each shell completes an argument that is one of some words, or a file by its ending.

    Words are not handed to shtab as choices: zsh would take a colon in one for its own.
    """
    listed = " ".join(words)
    endings = " ".join(files)
    name = re.sub(r"\W", "_", f"_{'file' if files else 'word'}_of_{argument}")
    zsh = [f"  compadd -- {listed}"]
    bash = [f'  compgen -W "{listed}" -- "$1"']
    fish = f"printf '%s\\n' {listed}"
    if files:
        pattern = " ".join(f"*{ending}" for ending in files)
        zsh = [f"  _alternative 'names:name:({listed})' 'files:file:_files -g \"{pattern}\"'"]
        loop = f"for ending in {endings}; do compgen -f -X"
        bash += [f'  {loop} "!*$ending" -- "$1"; done']
        bash += ['  compgen -d -- "$1"']
        fish += f"; __fish_complete_suffix {endings}"
    functions = {shell: "\n".join([f"{name}() {{", *lines, "}"]) for shell, lines in
                 (("bash", bash), ("zsh", zsh))}  # fmt: skip
    return {"bash": name, "zsh": name, "fish": f"({fish})", "preamble": functions}
