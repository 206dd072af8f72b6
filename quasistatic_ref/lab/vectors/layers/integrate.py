"""Layer `integrate`: q+ = q (+) delta_q of a mechanism."""

from quasistatic_ref.lab.program import integration as program
from quasistatic_ref.lab.vectors.exact.entered import exact_case
from quasistatic_ref.lab.vectors.exact.precision import rounded_results
from quasistatic_ref.lab.vectors.expected import Expected, Json, Tolerance

EPS = 2.0**-52
ROUNDINGS = 8.0
"""Units of rounding in a translation R V v + t, 3 products deep, or in a product of two
quaternions; the package's own answers stay below 4."""


def expected(case_input: Json) -> Expected:
    """The next configuration; quaternions and (cos, sin) have length one."""
    case = exact_case(case_input)
    delta_q = case_input["delta_q"]
    output, digits = rounded_results(lambda: program.integrate(case))
    # The angle of a turn is rounded to its own last bit before its sine is taken.
    size = max([1.0, *(abs(x) for x in [*output["q"], *delta_q])])
    reason = f"{ROUNDINGS:g} units of rounding of coordinates and angles up to {size:.3g}"
    return Expected(output, digits, tolerance={"q": Tolerance(EPS * ROUNDINGS * size, reason)})


def own(case_input: Json) -> Json:
    """The package's next configuration."""
    from quasistatic_ref.lab.vectors.own.system import own_system

    mine = own_system(case_input["mechanism"])
    q = mine.model_q(case_input["q"])
    after = mine.system.integrate(q, mine.model_v(case_input["delta_q"]))
    return {"q": (after[mine.q] + 0.0).tolist()}
