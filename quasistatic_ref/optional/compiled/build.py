"""The library of the C files: made when the package is installed, by hatch_build.py.

It needs nothing but Python and a C compiler. ``python quasistatic_ref/optional/compiled/build.py``
makes the library of a checkout that is not installed.
"""

import hashlib
import os
import shlex
import shutil
import sys
from pathlib import Path

FOLDER = Path(__file__).parent
SOURCE = FOLDER / "source"
LIBRARY = FOLDER / "compiled.so"
VARIABLE = "QUASISTATIC_REF_COMPILED"
"""The variable of the environment that turns compiled code off, if it is 0: when the package is
installed, or when it runs."""
PROBLEM = FOLDER / "not_compiled.txt"
"""Why there is no library, in words; made in its place."""
UNREAD = ("-fno-math-errno", "-fno-trapping-math")
"""Nobody reads errno or the processor's flags: comparisons and square roots are of several numbers
at once, whose bits are the same."""
FLAGS = ("-std=c11", "-O3", "-ffp-contract=off", *UNREAD, "-shared", "-fPIC")
"""The third: no compiler may join a product and a sum that the source keeps apart."""


def digest() -> str:
    """A hash of the library's sources and compiler flags."""
    files = sorted(SOURCE.glob("*.[ch]"))
    text = b"\0".join(part for file in files for part in (file.name.encode(), file.read_bytes()))
    return hashlib.sha256(text + repr(FLAGS).encode()).hexdigest()[:32]


def problem() -> str | None:
    """Compile the library; return why there is none, in words, or None."""
    import subprocess  # not needed where there is a library

    if os.environ.get(VARIABLE) == "0":
        return f"{VARIABLE} was 0"
    try:
        compiler = shlex.split(os.environ.get("CC", "")) or [
            path for path in [shutil.which("cc")] if path
        ]
    except ValueError as error:
        return f"$CC cannot be read as a command: {error}"
    if not compiler:
        return "there was no C compiler, cc or $CC"
    files = [str(file) for file in sorted(SOURCE.glob("*.c"))]
    made = LIBRARY.with_suffix(".made")
    command = [*compiler, *FLAGS, f'-DDIGEST="{digest()}"', "-o", str(made), *files, "-lm"]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, errors="replace", check=False
        )
    except OSError as error:
        return f"{compiler[0]} cannot be run: {error.strerror}"
    if done.returncode or not made.exists():
        lines = [line for line in done.stderr.splitlines() if "error" in line]
        why = lines[0].strip() if lines else f"exit status {done.returncode}"
        return f"{compiler[0]} could not compile it: {why}"
    made.replace(LIBRARY)
    return None


def build() -> Path:
    """Compile the library, or write why this failed; return the path of the file."""
    for file in (LIBRARY, PROBLEM):
        file.unlink(missing_ok=True)
    why = problem()
    if why is None:
        return LIBRARY
    PROBLEM.write_text(why, encoding="utf-8")
    return PROBLEM


if __name__ == "__main__":
    sys.exit(None if build() == LIBRARY else PROBLEM.read_text("utf-8"))
