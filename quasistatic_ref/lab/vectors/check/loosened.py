"""What is required of programs that are right to fewer digits than float64 holds."""

from quasistatic_ref.lab.vectors.check.compare import leaves, parts, tolerance_of
from quasistatic_ref.lab.vectors.check.multipliers import NEGLIGIBLE
from quasistatic_ref.lab.vectors.layers.derivative import SHARE
from quasistatic_ref.lab.vectors.layers.qp import UNIQUE
from quasistatic_ref.lab.vectors.trees import Json

AGREED = 2.5e-10
"""Tolerance over the largest number of a field [-] of what package and plain program agreed
on; a challenge allows four times as much, 1e-9."""


def loosened(record: Json, digits: float) -> Json:
    """The expected output for a program that works to `digits` decimal digits [-].

    Every tolerance is what float64's would be with that unit of rounding, 10^-digits in the place
    of 1e-16 (of derivatives: of 1e-9; of what was agreed on: of AGREED), and at least 10^-digits of
    the largest number of its field. Whole numbers stay, but for distances that these digits do not
    tell apart.

    Parameters
    ----------
    record : dict
        What is expected: ``output``, ``flags``, ``tolerance``.
    digits : float
    """
    unit = 10.0**-digits
    wide = {}
    flags = dict(record["flags"])
    rounding = AGREED if flags.get("agreed") else 1e-16
    rounding = SHARE if "differentiable" in record["output"] else rounding
    for field, value in parts(record["output"]).items():
        numbers = [abs(v) for _, v in leaves(value) if isinstance(v, float)]
        exact = tolerance_of(record["tolerance"], field)
        if numbers and field != "farkas":
            loose = max(exact * unit / rounding, unit * max(numbers))
            wide[field] = {"absolute": loose, "exact": exact}
        if field == "lam" and numbers:
            known = wide[field]["absolute"] <= UNIQUE * max(numbers)
            flags["unique_multipliers"] = flags["unique_multipliers"] and known
    if "farkas" in record["output"]:
        wide["farkas"] = {"absolute": max(tolerance_of(record["tolerance"], "farkas"), unit)}
    small = {"negligible": max(NEGLIGIBLE, unit), "rounding": unit}
    return {**record, "tolerance": {**record["tolerance"], **wide}, "flags": flags, **small}
