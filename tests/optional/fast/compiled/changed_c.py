"""The sources of the compiled library, copied with one text of one file replaced."""

import ctypes
import subprocess

from quasistatic_ref.optional.fast.compiled import library


def changed_sources(folder, name, text, other):
    """Copy all C files to a folder; where `text` is not empty, `name` has `other` in its place."""
    sources = library.SOURCE
    for file in (*sources.glob("*.c"), *sources.glob("*.h")):
        code = file.read_text()
        if file.name == name and text:
            assert code.count(text) == 1
            code = code.replace(text, other)
        (folder / file.name).write_text(code)


def library_of(folder, file, *flags):
    """The functions of one file of a folder, which calls no other."""
    out = folder / "alone.so"
    command = [*library.compiler(), *library.FLAGS, *flags, "-o", out, folder / file, "-lm"]
    subprocess.run(command, check=True, capture_output=True)
    return ctypes.CDLL(str(out))
