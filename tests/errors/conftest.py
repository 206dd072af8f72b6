"""The command line in this process, held to its manners."""

import shlex
import time

import pytest

from tests.helpers import one_sentence

SLOWEST = 10.0
"""No input may keep the processor busy for longer before it is refused [s]."""


@pytest.fixture
def refused(tmp_path, cli):
    """Run a command that must fail, each argument one word, and return its one sentence.

    Nothing is printed but that sentence, nothing is written, and it does not take long.
    """

    def run(*arguments, status=2):
        before = set(tmp_path.rglob("*"))
        start = time.process_time()
        printed = cli(*(shlex.quote(str(word)) for word in arguments), status=status)
        assert time.process_time() - start < SLOWEST
        assert printed.out == ""
        assert set(tmp_path.rglob("*")) == before
        return one_sentence(printed.err)

    return run
