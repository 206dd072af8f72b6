"""The C files of this folder, compiled once for each user and machine, and loaded with ctypes.

A compiler is looked for in this order: the command that ``QUASISTATIC_REF_CC`` names (``none`` asks
for no compiled code at all), the system's ``cc``, ``gcc`` or ``clang``, and the Python package
``ziglang``, which the extra ``[fast]`` brings. The library is kept in the user's cache folder
(``cache.py``), under a name that follows from the source and the command. Before it comes there, it
is tested in a process of its own (``selftest.py``): it might be wrong, and loading a library may
already change the arithmetic of a process. A library whose load did not end is tested again.
Whatever goes wrong is said in a sentence, and the plain path takes the steps.
"""

import ctypes
import hashlib
import os
import platform
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from quasistatic_ref import tolerances
from quasistatic_ref.contact.crossings import EDGE_COSINE
from quasistatic_ref.contact.tied_faces import TURNED
from quasistatic_ref.formats.quoting import clipped, one_line
from quasistatic_ref.optional.fast.compiled.cache import Cache, CompileError

VARIABLE = "QUASISTATIC_REF_CC"
NONE = "none"
SOURCE = Path(__file__).parent / "source"
TESTED_BY = ("selftest.py", "known_pairs.py")
SELFTEST = "quasistatic_ref.optional.fast.compiled.selftest"
CONSTANTS = {
    **{
        name: getattr(tolerances, name)
        for name in (
            "FILLED", "ON_RIM", "ON_SURFACE", "OUTSIDE_FACE", "OVER_FACE", "REPEATED",
            "SAME_NORMAL", "SKEW", "TIED_FACES", "UNMOVED", "UNSEEN", "UPRIGHT",
        )
    },
    "ON_SURFACE_SQUARED": tolerances.ON_SURFACE**2, "TURNED": TURNED, "LEVEL": EDGE_COSINE,
}  # fmt: skip
"""Numbers of Python that C reads by the same names."""
FLAGS = (
    "-std=c11", "-O3", "-ffp-contract=off", "-shared", "-fPIC",
    *(f"-D{name}={value.hex()}" for name, value in CONSTANTS.items()),
)  # fmt: skip
"""The third: no compiler may join a product and a sum that the source keeps apart."""
PATIENCE = 120.0
"""Time that a compiler, or the self-test, is given [s]. Compilers take 0.4 to 4 s."""

FUNCTIONS = {
    "closest_points": ctypes.c_int,
    "step_data": ctypes.c_double,
    "squared_distances": ctypes.c_double,
    "half_turns": ctypes.c_int,
    "sums": None,
    "turns": ctypes.c_int,
    "changes": None,
    "natural_program": ctypes.c_int,
}
"""What each function returns; its one argument is the address of a structure."""


chosen: str | None = None
"""The file that this process loads, once it is set: the self-test's, of a library not yet kept."""


def library() -> ctypes.CDLL:
    """The compiled functions.

    Raises
    ------
    CompileError
    """
    found = _found()
    if isinstance(found, str):
        raise CompileError(found)
    return found


def why_not() -> str | None:
    """Why there is no library, in words; None if there is one."""
    found = _found()
    return found if isinstance(found, str) else None


def described() -> str:
    """The compiler and the file of the library, in words."""
    return f"compiler {shlex.join(compiler())}, library {library()._name}"


@cache
def _found() -> ctypes.CDLL | str:
    if platform.system() == "Windows" or sys.maxsize < 2**32:
        return "it is made for 64-bit Linux and macOS only"
    try:
        return _bound(chosen) if chosen else _kept(compiler())
    except CompileError as reason:
        return str(reason)
    except (OSError, AttributeError) as failure:  # a symbol that is missing is the second
        return f"it could not be compiled or loaded: {clipped(str(failure))}"


def _bound(file: str) -> ctypes.CDLL:
    """A library that is loaded, with the types of its functions."""
    found = ctypes.CDLL(file)
    for name, result in FUNCTIONS.items():
        function = getattr(found, name)
        function.argtypes = [ctypes.c_void_p]
        function.restype = result
    return found


def compiler() -> list[str]:
    """The command that compiles C.

    Raises
    ------
    CompileError
        If there is none, or its command cannot be read.
    """
    named = os.environ.get(VARIABLE, "")
    if named == NONE:
        raise CompileError(f"{VARIABLE} says {NONE}")
    try:
        command = shlex.split(named)
    except ValueError as problem:
        raise CompileError(f"{VARIABLE} cannot be read as a command: {problem}") from None
    for name in ("cc", "gcc", "clang"):
        command = command or [path for path in [shutil.which(name)] if path]
    if not command:
        if find_spec("ziglang") is None:
            raise CompileError(
                "there is no C compiler: install one, or the extra: "
                'pip install "quasistatic-ref[fast]"'
            )
        command = [sys.executable, "-m", "ziglang", "cc"]
    return command


def _kept(command: list[str]) -> ctypes.CDLL:
    """The library of a compiler: the one that is kept, or one that is made and tested."""
    cache = Cache(key(command))
    file = cache.library()
    if file is not None and cache.was_left() and (complaint := _complaint(testing(file))):
        print(f"quasistatic_ref: the library is replaced: {complaint}", file=sys.stderr, flush=True)
        cache.remove(file)
        file = None
    if file is None:
        print("quasistatic_ref: compiling, once ...", file=sys.stderr, flush=True)
        with tempfile.TemporaryDirectory(dir=cache.folder) as folder:
            made = Path(folder) / "made.so"
            works = (
                (compiling(command, made), "could not compile it"),
                (testing(made), "is not used"),
            )
            for work, failed in works:
                if complaint := _complaint(work):
                    raise CompileError(f"{command[0]} {failed}: {complaint}")
            file = cache.keep(made)
    with cache.loading():
        return _bound(str(file))


def key(command: list[str]) -> str:
    """What follows from all that a library is made of, and tested by."""
    files = [*sorted(SOURCE.glob("*.[ch]")), *(SOURCE.parent / name for name in TESTED_BY)]
    text = b"".join(file.read_bytes() for file in files)
    made_by = repr((command, FLAGS, sys.platform, platform.machine()))
    return hashlib.sha256(text + made_by.encode()).hexdigest()


def compiling(command: Sequence[str], out: Path) -> list[str]:
    """The command that makes a library of the C files."""
    files = [str(file) for file in sorted(SOURCE.glob("*.c"))]
    return [*command, *FLAGS, "-o", str(out), *files, "-lm"]


def testing(library: Path) -> list[str]:
    """The command that tests a library in a process of its own."""
    return [sys.executable, "-P", "-m", SELFTEST, str(library)]


def _complaint(command: Sequence[str]) -> str:
    """What a command says last if it fails, or that it does not end; empty if all is well."""
    with subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},  # the same packages
        start_new_session=True,
    ) as process:
        try:
            _, output = process.communicate(timeout=PATIENCE)
        except BaseException as ended:  # Ctrl-C as well: nothing goes on without us
            os.killpg(process.pid, signal.SIGKILL)
            if not isinstance(ended, subprocess.TimeoutExpired):
                raise
            return f"it did not end in {PATIENCE:g} s ({VARIABLE}={NONE} asks for no compiler)"
    if not process.returncode:
        return ""
    lines = output.decode("utf-8", "replace").strip().splitlines()
    signalled = f"it was ended by signal {-process.returncode}"
    silent = signalled if process.returncode < 0 else "without a word"
    errors = [line for line in lines if "error" in line] or lines[-1:] or [silent]
    return one_line(clipped(errors[0]))
