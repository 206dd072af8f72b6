"""The arithmetic that every proof starts and ends with: float64, with its subnormal numbers.

A processor can round in other directions than to nearest, and flush subnormal numbers to zero
(FTZ, DAZ). Both are set for each thread, and any library may set them: many that are compiled with
``-ffast-math`` do when they are loaded. A step's numbers then become others before they are exact,
and an answer after it was proved.
"""

from quasistatic_ref.errors import InputError

ONE = 1.0
TINY = 2.0**-60
"""Added to 1 or taken from it, it changes nothing, unless rounding is upwards or downwards."""
NORMAL = 2.0**-1022
HALF = 0.5
"""Half of the smallest normal number is subnormal: zero where it is flushed, written or read."""


def check_arithmetic() -> None:
    """Refuse to prove anything in a thread whose float64 numbers are not those of IEEE 754.

    Takes 0.1 us; stands before each search for a proof, after what a backend may have left behind,
    and before each check of a proof.

    Raises
    ------
    InputError
        If rounding is not to nearest, or subnormal numbers are flushed to zero.
    """
    if ONE + TINY == ONE - TINY and NORMAL * HALF > 0.0:
        return
    rounds = ONE + TINY != ONE - TINY
    what = "does not round to nearest" if rounds else "flushes subnormal numbers to zero"
    raise InputError(
        f"nothing can be proved in this thread: its arithmetic {what}, a mode of the processor "
        "that another library has set (one compiled with -ffast-math does so when it is loaded); "
        "use a process without that library, or reset the mode"
    )
