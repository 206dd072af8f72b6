"""Layer `derivative`: of q+ by q, q_bar_a, forces and parameters, or why there is none.

Nothing is rounded from the mechanism to q+, as ``lab/vectors/unrounded`` has it. The numbers are
differences of such steps, each proved to 15 digits by a second difference.
"""

from flint import fmpq

from quasistatic_ref.certify.rounding import nearest_fraction
from quasistatic_ref.lab.vectors.exact.precision import Vector
from quasistatic_ref.lab.vectors.exact.rational import inverse, largest, rationals
from quasistatic_ref.lab.vectors.expected import Expected, Json, Tolerance
from quasistatic_ref.lab.vectors.unrounded.derivatives import Derivatives, derivatives
from quasistatic_ref.lab.vectors.unrounded.differences import Base, base
from quasistatic_ref.lab.vectors.unrounded.moved_inputs import with_held_wrenches
from quasistatic_ref.lab.vectors.unrounded.nearby import Touching
from quasistatic_ref.lab.vectors.unrounded.touching import touching_pairs

FIELDS = {
    "q": "dq_dq",
    "q_bar_a": "dq_dq_bar_a",
    "tau": "dq_dtau",
    "mu_v": "dq_dmu_v",
    "mu_omega": "dq_dmu_omega",
    "K_q": "dq_dK_q",
    "h": "dq_dh",
    "m": "dq_dm",
}
"""Name of each derivative in the output, a matrix of n_v rows; of h a list."""
SHARE = 1e-9
"""Of the largest entry, or of what the free step would show: the tolerance."""
QUIET = 1e-3
"""Share of the free step's derivative: smaller ones are compared with that share."""
STILL = 1e-6
"""Size of what is 0 because nothing pulls: neither contacts nor the free step move."""
NOTHING = fmpq(1, 1 << 60)
"""Share of a derivative's size, of which SHARE is the tolerance, below which an entry is 0."""


def expected(case_input: Json) -> Expected:
    """Every derivative in float64; or why there is none."""
    try:
        one = base(with_held_wrenches(case_input))
    except Touching:
        listed = touching_pairs(case_input)
        if not listed:  # apart or in penetration the pair has derivatives, but no closed form
            raise
        return _verdict([{"kind": "touching", "pair": p, "index": [0], "rows": []} for p in listed])
    found = derivatives(one)
    if found.reasons:
        return _verdict(found.reasons)
    return _numbers(one, found)


def own(case_input: Json) -> Json:
    """The package's answer."""
    from quasistatic_ref.lab.vectors.own.derivative import own_derivative

    return own_derivative(case_input)


def _verdict(reasons: Json) -> Expected:
    flags = {"differentiable": False, "switch": True}
    return Expected({"differentiable": False, "reasons": reasons}, flags=flags)


def _numbers(one: Base, found: Derivatives) -> Expected:
    output: dict[str, Json] = {"differentiable": True, "reasons": []}
    tolerance = {}
    free = free_sizes(one)
    for name, columns in found.columns.items():
        if not columns:
            continue
        field = FIELDS[name]
        largest = max(abs(x) for column in columns for x in column)
        size = max(float(largest), QUIET * free[name]) or STILL
        rows = [[_float(x, size) for x in row] for row in zip(*columns, strict=True)]
        output[field] = [row[0] for row in rows] if name == "h" else rows
        tolerance[field] = Tolerance(float(f"{SHARE * size:.1e}"), _why(float(largest), free[name]))
    flags = {"differentiable": True, "switch": found.switch}
    return Expected(output, flags=flags, tolerance=tolerance)


def _float(x: fmpq, size: float) -> float:
    return 0.0 if abs(x) <= NOTHING * fmpq(*size.as_integer_ratio()) else nearest_fraction(x)


def _why(largest: float, free: float) -> str:
    if largest >= QUIET * free:
        return f"{SHARE:g} of the largest entry"
    return f"{SHARE:g} of a thousandth of what the step without contacts shows"


def free_sizes(one: Base) -> dict[str, float]:
    """The largest entry, roughly, of each derivative of the step without contacts, as FIELDS."""
    case = one.at.case
    inverse_H = inverse(rationals(one.step.H.ravel()).reshape(one.step.H.shape))
    x = float(largest(inverse_H @ one.step.g))
    flexible = float(largest(inverse_H))
    K: Vector = [row[j] for j, row in enumerate(case["K_q"])]
    masses = [body["mass"] for body in case["mechanism"]["bodies"] if body.get("mass")]
    pairs = case["pairs"]
    return {
        "q": 1.0,
        "q_bar_a": 1.0,
        "tau": float(case["h"]) * flexible,
        "mu_v": x / _least([p["mu_v"] for p in pairs]),
        "mu_omega": x / _least([p["mu_omega"] for p in pairs]),
        "K_q": x / _least(K),
        "h": x / float(case["h"]),
        "m": x / _least(masses),
    }


def _least(values: Vector) -> float:
    return float(min((v for v in values if v), default=1.0))
