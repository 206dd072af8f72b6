"""The test that a compiled library has to pass: it finds what compilers do to bits."""

import subprocess
import sys

import pytest

from quasistatic_ref.optional.fast.compiled import compiled
from tests.optional.fast.compiled.test_fast import needs_compiler

pytestmark = needs_compiler
CHANGED = {
    "-ffast-math": "x / ",  # by y or by 3, as the compiler likes
    "-ffp-contract=fast -mfma": "x y + z",
    "-fassociative-math -fno-signed-zeros -fno-trapping-math": "x + y - x",
    "-freciprocal-math": "x / 3",
    "-ffinite-math-only": "x == x",
    "-fno-signed-zeros": "0 - x",
    "-fsingle-precision-constant": "0.1 x",
}
"""Flags, and the first operation of which they change the bits."""


def refusal(folder, flags):
    """What the test says of a library of the tested operations alone, compiled with more flags."""
    made = compiled("library")
    out = str(folder / "made.so")
    command = [
        *made.compiler(),
        *made.FLAGS,
        *flags.split(),
        "-o",
        out,
        str(made.SOURCE / "arithmetic.c"),
    ]
    subprocess.run([*command, "-lm"], check=True, capture_output=True)
    testing = [sys.executable, "-I", str(made.SOURCE.parent / made.SELFTEST), out]
    return subprocess.run(testing, capture_output=True, text=True, check=False).stderr


@pytest.mark.parametrize("flags", ["", "-O0", "-march=native"])
def test_a_library_whose_bits_are_right_passes(tmp_path, flags):
    assert refusal(tmp_path, flags) == ""


@pytest.mark.parametrize("flags", CHANGED)
def test_a_library_whose_bits_are_others_is_refused(tmp_path, flags):
    assert refusal(tmp_path, flags).startswith(
        f"its arithmetic is not that of float64: {CHANGED[flags]}"
    )
