"""The command line in this process, held to its manners."""

import time

import pytest

from quasistatic_ref.cli.main import main

SLOWEST = 10.0
"""No input may keep the processor busy for longer before it is refused [s]."""


@pytest.fixture
def refused(tmp_path, capsys):
    """Run a command that must fail, and return its one sentence.

    Nothing is printed but that sentence, nothing is written, and it does not take long.
    """

    def run(*arguments, status=2):
        before = paths_below(tmp_path)
        start = time.process_time()
        assert main([str(argument) for argument in arguments]) == status
        assert time.process_time() - start < SLOWEST
        captured = capsys.readouterr()
        assert captured.out == ""
        lines = captured.err.splitlines()
        assert len(lines) == 1, captured.err
        assert lines[0].startswith("quasistatic-ref: ")
        assert paths_below(tmp_path) == before
        return lines[0].removeprefix("quasistatic-ref: ")

    return run


def paths_below(folder):
    """All files and folders below a folder."""
    return set(folder.rglob("*"))
