"""What tests say of a mutant: they import it in a fork of this process.

This process has imported what the package needs, so that a fork takes half a second more than its
tests.
"""

import os
import resource
import signal
import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.machinery import SourceFileLoader
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

ROOT = Path(__file__).parents[3]
PACKAGE = ROOT / "quasistatic_ref"
NEEDED = ("coal", "cvxpy", "flint", "hypothesis", "pinocchio", "scipy.optimize", "scipy.spatial")
SECONDS = 30
"""Of the processor that one test may take [s]: a mutant may loop."""
WALL = 600
"""Seconds after which tests that wait for something are ended."""
MEMORY = 8 << 30
"""Bytes that they may gather."""
OPTIONS = ("-x", "-q", "--tb=no", "-p", "no:cacheprovider", "-p", "no:xdist",
           "-W", "ignore::pytest.PytestAssertRewriteWarning", f"--rootdir={ROOT}")  # fmt: skip

for needed in NEEDED:
    import_module(needed)


def replace_source(file: Path, text: str) -> None:
    """Make a file of the package, when it is imported, have another text."""
    as_it_is = SourceFileLoader.get_code

    def get_code(loader: SourceFileLoader, name: str) -> object:
        if Path(loader.path) != file:
            return as_it_is(loader, name)
        return loader.source_to_code(text, loader.path)

    SourceFileLoader.get_code = get_code  # type: ignore[method-assign]  # of this fork alone


class Patience:
    """A plugin of pytest that ends the process where a test takes too long."""

    def pytest_runtest_setup(self) -> None:
        """Let this process use so many more seconds of the processor from now on."""
        used = resource.getrusage(resource.RUSAGE_SELF)
        limit = int(used.ru_utime + used.ru_stime) + SECONDS
        resource.setrlimit(resource.RLIMIT_CPU, (limit, resource.RLIM_INFINITY))


def said_of(file: str, source: str, tests: Sequence[str]) -> str:
    """What tests say of a file of the package with another text.

    ``"killed"``, ``"broken"`` (it cannot be imported, or crashes) or ``"hangs"``: all of these are
    noticed. Or ``"survived"``.
    """
    with TemporaryDirectory() as folder:
        child = os.fork()
        if not child:
            os.environ["PYTEST_DEBUG_TEMPROOT"] = folder  # two at a time would share one
            os._exit(_status(PACKAGE / file, source, tests))
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    words = {0: "survived", 1: "killed", -signal.SIGXCPU: "hangs", -signal.SIGALRM: "hangs"}
    return words.get(status, "broken")


def _status(file: Path, source: str, tests: Sequence[str]) -> int:
    """The exit status of the tests in this process, which knows no module of ours any more."""
    signal.alarm(WALL)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    nothing = os.open(os.devnull, os.O_RDWR)
    for stream in range(3):
        os.dup2(nothing, stream)
    for name in list(sys.modules):
        if name.partition(".")[0] in ("quasistatic_ref", "tests", "validation"):
            del sys.modules[name]
    replace_source(file, source)
    paths = [str(ROOT / "tests" / test) for test in tests]
    try:
        return int(pytest.main([*OPTIONS, *paths], plugins=[Patience()]))
    except BaseException:
        return os.EX_SOFTWARE
