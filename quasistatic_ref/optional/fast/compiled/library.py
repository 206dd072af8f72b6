"""The C files of this folder, compiled once for each user and machine, and loaded with ctypes.

A compiler is looked for in this order: the command that ``QUASISTATIC_REF_CC`` names (``none`` asks
for no compiled code at all), the system's ``cc``, ``gcc`` or ``clang``, and the Python package
``ziglang``, which the extra ``[fast]`` brings. The library is kept in the user's cache folder,
``XDG_CACHE_HOME`` or ``~/.cache``, under a name that follows from the source and the command.
Before it comes there, its arithmetic is tested in a process of its own (``selftest.py``), because
loading a library may already change the arithmetic of a process. Whatever goes wrong is said in a
sentence, and steps are NumPy's.
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

VARIABLE = "QUASISTATIC_REF_CC"
NONE = "none"
SOURCE = Path(__file__).parent / "source"
SELFTEST = "selftest.py"
CONSTANTS = {
    **{
        name: getattr(tolerances, name)
        for name in (
            "FILLED", "ON_RIM", "ON_SURFACE", "OUTSIDE_FACE", "OVER_FACE", "REPEATED",
            "SAME_NORMAL", "SKEW", "TIED_FACES", "UPRIGHT",
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
    "solid_pairs": ctypes.c_int,
    "step_data": ctypes.c_double,
    "reach": ctypes.c_double,
    "half_turns": ctypes.c_int,
    "sums": None,
    "turns": ctypes.c_int,
    "changes": None,
    "natural_program": ctypes.c_int,
    "hessian": ctypes.c_int,
    "proof": ctypes.c_int,
    "groups_proved": ctypes.c_int,
}
"""What each function returns; its one argument is the address of a structure."""


class CompileError(Exception):
    """Why there is no library, in words."""


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


@cache
def _found() -> ctypes.CDLL | str:
    if platform.system() == "Windows" or sys.maxsize < 2**32:
        return "it is made for 64-bit Linux and macOS only"
    try:
        found = ctypes.CDLL(str(_made(compiler())))
        for name, result in FUNCTIONS.items():
            function = getattr(found, name)
            function.argtypes = [ctypes.c_void_p]
            function.restype = result
    except CompileError as reason:
        return str(reason)
    except (OSError, AttributeError) as failure:  # a symbol that is missing is the second
        return f"it could not be compiled or loaded: {clipped(str(failure))}"
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


def _made(command: list[str]) -> Path:
    """The library's file, made if it is not there."""
    selftest = SOURCE.parent / SELFTEST
    files = sorted(SOURCE.glob("*.[ch]"))
    text = b"".join(file.read_bytes() for file in [*files, selftest])
    key = hashlib.sha256(
        text + repr((command, FLAGS, sys.platform, platform.machine())).encode()
    ).hexdigest()
    folder = _cache() / "quasistatic_ref"
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    if folder.stat().st_uid != os.getuid():
        raise CompileError(f"{folder} belongs to another user")
    file = folder / f"fast-{key[:16]}.so"
    if not file.exists():
        print("quasistatic_ref: compiling, once ...", file=sys.stderr, flush=True)
        with tempfile.TemporaryDirectory(dir=folder) as made:
            out = Path(made) / file.name
            sources = [str(file) for file in files if file.suffix == ".c"]
            compiling = [*command, *FLAGS, "-o", str(out), *sources, "-lm"]
            testing = [sys.executable, "-I", str(selftest), str(out)]
            for work, failed in ((compiling, "could not compile it"), (testing, "is not used")):
                if complaint := _complaint(work):
                    raise CompileError(f"{command[0]} {failed}: {complaint}")
            os.replace(out, file)
    return file


def _cache() -> Path:
    """The user's cache folder; CompileError if there is none."""
    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    except RuntimeError:
        problem = "there is no home folder to keep it in: set XDG_CACHE_HOME or HOME"
        raise CompileError(problem) from None


def _complaint(command: Sequence[str]) -> str:
    """What a command says last if it fails, or that it does not end; empty if all is well."""
    with subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
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
