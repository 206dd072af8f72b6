"""``quasistatic-ref``: one sub-command a file; nothing heavy is imported before it is needed.

Exit status: 0 good, 1 a check failed, 2 bad input, 3 a step without solution, 130 interrupted
(143 and 129 where SIGTERM or SIGHUP ended a run).
"""

import argparse
import io
import os
import re
import shlex
import sys
from collections.abc import Container, Mapping, Sequence
from importlib import import_module
from types import ModuleType
from typing import Any, NoReturn

from quasistatic_ref import __version__
from quasistatic_ref.errors import InputError, QuasistaticError
from quasistatic_ref.quoting import clipped, nearest_name, suggestion
from quasistatic_ref.simulate.interrupt import exit_status

CORE = "quasistatic_ref.cli"
LAB = "quasistatic_ref.lab.commands"
COMMANDS = {
    "demo": "draw the paper's Figure 1: a bunny grasped with and without torsional friction",
    "run": "simulate a scenario and write its trajectory",
    "solve": "solve one step and write its exact answer with a certificate",
    "verify": "check an answer and its certificate without any solver",
    "inspect": "show what a URDF or a scenario contains, and what the model ignores",
    "body": "make a body for a scenario from a scan, a point cloud or a mesh",
    "qp": "solve a quadratic program exactly, and compare the answers of solvers",
    "stands": "say which bodies of a scene would not stay, and what they lack",
    "opinion": "compare the contact forces of a MuJoCo scene with the exact ones",
    "extract": "write one step of a trajectory as a step file",
    "vectors": "check another implementation against reference vectors, layer by layer",
    "validate": "test claims about the model against the paper, formulas and other engines",
    "study": "compare solvers on problems with exact answers",
    "figures": "run the scripts of the gallery, and write their figures",
    "bench": "measure the time of a step, plain and fast, proved and unproved, next to MuJoCo's",
    "backends": "list the solvers that are installed here",
    "schema": "print the JSON Schema of a kind of file, for editors and other programs",
}
SWEEP = "sweep"
"""What does ``run`` with ``--sweep``."""
OF_CORE = ("run", "solve", "verify", "inspect", "extract", "backends")
"""Commands of the core; the others do something with it, or ask an optional part alone."""


class Parser(argparse.ArgumentParser):
    """An argument parser that suggests the nearest command, action of a command or option."""

    def error(self, message: str) -> NoReturn:
        """Exit with status 2 and a sentence."""
        problem, _, choices = message.partition(" (choose from")
        hint = ""
        if unknown := re.search(r"invalid choice: '([^']*)'", message):
            hint = suggestion(unknown[1], re.findall(r"\w+", choices))
        elif unknown := re.search(
            r"unrecognized arguments: --([\w-]+)(?: ([^\s=]+)(?!\S))?", problem
        ):
            hint = nearest_name(f"--{unknown[1]}", self._option_string_actions)
            if unknown[2] and "--set" in self._option_string_actions and _is_field(unknown[1]):
                hint = f"; did you mean '--set {unknown[1]}={unknown[2]}'?"
        elif unknown := re.search(r"unrecognized arguments: ([\w.]+=\S+)", message):
            hint = f"; did you mean '--set {unknown[1]}'?"
        super().error(f"{problem}{hint}")

    def parse_known_args(self, *arguments: Any) -> Any:  # type: ignore[override]  # one method for all of typeshed's overloads
        """Parse all arguments; an unknown one is reported by the command that received it."""
        options, unknown = super().parse_known_args(*arguments)
        if unknown:
            self.error(f"unrecognized arguments: {' '.join(unknown)}")
        return options, unknown


def _is_field(name: str) -> bool:
    """Whether a name is a top-level field of scenarios, such as ``steps``."""
    tables = import_module("quasistatic_ref.files.scenario.scenario_table")
    return name in tables.TABLES[tables.TOP]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; never a traceback for bad input.

    Parameters
    ----------
    arguments : sequence of str, optional
        ``sys.argv[1:]`` by default.

    Returns
    -------
    int
        Exit status.
    """
    return status(parsed(sys.argv[1:] if arguments is None else list(arguments)))


def parsed(arguments: list[str]) -> argparse.Namespace:
    """The options of the command that the arguments name; only its module is imported."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # closed, as by >&-: what is printed goes nowhere
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115 open until the process ends
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # what a terminal cannot show is escaped
            stream.reconfigure(errors="backslashreplace")
    named = next((argument for argument in arguments if not argument.startswith("-")), None)
    try:  # only the command that is used declares its options: their modules may be heavy
        return command_parser([named]).parse_args(arguments)
    except ImportError as error:
        sys.exit(_failed(_not_installed(error), 2))


def status(options: argparse.Namespace) -> int:
    """Run the command; its exit status."""
    try:
        return _run(options)
    except InputError as error:
        error.change = error.change or _option(error, options)
        return _failed(error, 2)
    except QuasistaticError as error:
        return _failed(error, 3)
    except KeyboardInterrupt as ended:
        return _failed(str(ended) or "interrupted", exit_status(ended))
    except BrokenPipeError:  # the reader of our output, such as `head`, went away
        sys.stderr.close()
        return 0
    except ImportError as error:
        return _failed(_not_installed(error), 2)
    except MemoryError:
        return _failed("this needs more memory than there is", 2)
    except OSError as error:  # files are wrapped where they are used: without a name, it is ours
        reason = error.strerror or str(error)
        if error.filename is not None:
            return _failed(f"{clipped(str(error.filename))}: cannot be used: {reason}", 2)
        _discard_output()
        return _failed(f"standard output: cannot be written: {reason}", 2)


def _option(error: InputError, options: argparse.Namespace) -> str | None:
    """The option, as the user wrote it, that holds the value of an error; or None."""
    written = getattr(options, str(error.field), None)
    if isinstance(written, list):  # each is NAME=VALUE, and the error is about a name
        of_name = [setting for setting in written if setting.partition("=")[0] == error.value]
        return f"--{error.field} {shlex.quote(of_name[-1])}" if of_name else None
    if written is None or written is False or written != error.value:
        return None
    word = f"{written:g}" if isinstance(written, float) else str(written)
    return f"--{error.field} {shlex.quote(word)}"


def _not_installed(error: ImportError) -> str:
    """A sentence on the package that is missing; an import error of our own is raised again."""
    library = re.match(r"(\S+\.so\S*): cannot open shared object", str(error))
    if library is not None:
        problem = f"{library[1]}, which a package needs, is not installed on this system"
        return f"{problem}; libgomp.so.1 comes by: apt-get install libgomp1"
    package, *_ = (error.name or "").split(".")
    if not isinstance(error, ModuleNotFoundError) or package in ("", __package__.split(".")[0]):
        raise error
    return (
        f"this needs {package}, which is not installed here; a light installation checks vectors "
        "and answers alone: install quasistatic-ref with its dependencies"
    )


def command_parser(named: Container[str | None]) -> Parser:
    """The parser of all commands, of which those in `named` have options."""
    parser = Parser(
        prog="quasistatic-ref",
        description="Convex quasi-dynamic simulation with torsional friction: the reference.",
    )
    parser.add_argument("--version", action="version", version=__version__)
    for name, command in parsers_of(parser, "command", COMMANDS, "COMMAND").items():
        if name in named:
            _module(name).add_options(command)
            for last in _actions(command):
                last.add_argument("--quiet", action="store_true", help="show no progress")
    return parser


def parsers_of(
    parser: argparse.ArgumentParser, dest: str, actions: Mapping[str, str], metavar: str = "ACTION"
) -> dict[str, argparse.ArgumentParser]:
    """A parser for each action of a command, by name.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    dest : str
        The attribute of the options that is to hold the action's name.
    actions : mapping of str to str
        What each does, in words that begin with a small letter.
    metavar : str
        What stands for the action in the usage.
    """
    below = parser.add_subparsers(dest=dest, metavar=metavar, required=True)
    return {
        name: below.add_parser(name, help=words, description=f"{words[0].upper()}{words[1:]}.")
        for name, words in actions.items()
    }


def _actions(command: argparse.ArgumentParser) -> list[argparse.ArgumentParser]:
    """The parsers of a command's actions; its own, if it has none."""
    actions: list[argparse.ArgumentParser] = []
    for choice in command._actions:
        if isinstance(choice, argparse._SubParsersAction):
            for action in choice.choices.values():
                actions += _actions(action)
    return actions or [command]


def _module(command: str) -> ModuleType:
    """Import the module of a command: the lab's are imported nowhere else in the core."""
    import_module("quasistatic_ref.solve.backends")  # hears what CVXPY logs when it is imported
    return import_module(f"{CORE if command in OF_CORE else LAB}.{command}")


def _run(options: argparse.Namespace) -> int:
    many = getattr(options, "sweeps", None)
    ended = int(_module(SWEEP if many else options.command).run(options))
    sys.stdout.flush()  # here, where a full device can still be reported
    return ended


def _discard_output() -> None:
    """Discard buffered output, which the interpreter would otherwise write again at exit."""
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, sys.stdout.fileno())
    os.close(null)


def _failed(error: object, status: int) -> int:
    print(f"quasistatic-ref: {error}", file=sys.stderr)
    return status
