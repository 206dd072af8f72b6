"""The optimum in second-order cones, enclosed in balls that are small enough for 30 digits."""

from fractions import Fraction
from math import inf

import numpy as np
from flint import arb, arb_mat

from quasistatic_ref.certify.form import StepForm
from quasistatic_ref.cli.decimals import decimal_string
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.exact.conditioning import ROUNDINGS, floors
from quasistatic_ref.lab.vectors.exact.precision import DIGITS, dyadic_fraction
from quasistatic_ref.lab.vectors.exact.rational import UNIT, tolerance
from quasistatic_ref.lab.vectors.expected import Expected
from quasistatic_ref.numbers.precision import working_precision
from quasistatic_ref.optional.ellipsoid.enclosure import BITS as PROVED
from quasistatic_ref.optional.ellipsoid.enclosure import checked_pair, enclosed_error
from quasistatic_ref.optional.gap import nearest_in, square_root
from quasistatic_ref.step.data import StepData

GAP = arb(2) ** -280
"""Duality gap at which to stop: an error of 2^-140, 1e-42 of the unconstrained step."""
BITS = 1536
LAM = Fraction(1, 2**20)
"""Relative tolerance of the multipliers, which are one choice of many: that of the interior."""
LOOSER = Fraction(1, 2**26) / (ROUNDINGS * UNIT)
"""||x - x*||_H^2 is at most twice the duality gap, of which float64 leaves 2^-53: x is off by 2^-26
of the unconstrained step, in place of some roundings."""


def enclosed_optimum(step: StepData) -> Expected:
    """The optimum of a step in the ellipsoid, each entry rounded from a ball that holds it.

    Raises
    ------
    InputError
        If no displacement strictly inside of all cones is found: there is no such case.
    """
    form = StepForm(step)
    pair = checked_pair(step, GAP, BITS)
    if pair is None:
        raise InputError("has no displacement strictly inside of all cones", field="second_order")
    with working_precision(BITS):
        inverse = form.H.inv()
        # Where no cone bears load, the gap is a ball about zero.
        radius = [square_root(2 * pair.gap * inverse[v, v]).upper() for v in range(form.n)]
        x = arb_mat(form.n, 1, [pair.x[v, 0] + arb(0, radius[v]) for v in range(form.n)])
        balls = {
            "delta_q": x.entries(),
            "A_lam": ((form.H * x - form.g) * (1 / form.h)).entries(),
            "slack": (form.A * x + form.c).entries(),
        }
        lam = [float(v / form.h) + 0.0 for v in pair.y]
        output = {name: [_nearest(v) for v in values] for name, values in balls.items()}
    with working_precision(PROVED):  # what `verify` proves, in the precision that it works in
        again = checked_pair(step)
        error = inf if again is None else enclosed_error(form, again, np.array(output["delta_q"]))
    x_off, net_off, slack_off = (LOOSER * bound for bound in floors(form))
    reach = {
        "delta_q": x_off,
        "A_lam": net_off,
        "slack": slack_off,
        "lam": LAM * Fraction(np.abs(lam).max(initial=0.0)),
    }
    why = "a duality gap of 1e-16, which float64 leaves, is an error of 1e-8 in the H norm"
    return Expected(
        output={**output, "lam": lam, "certificate": {"kind": "enclosure", "error_bound": error}},
        digits={name: [_digits(v) for v in balls[name]] for name in ("delta_q", "A_lam")},
        flags={"infeasible": False, "unique_multipliers": False},
        tolerance={name: tolerance(size, why) for name, size in reach.items()},
    )


def _nearest(ball: arb) -> float:
    """The float64 nearest to all of a ball; of one that may be zero, zero."""
    if ball.contains(0):
        return 0.0
    value = nearest_in(ball)
    return float(ball) if value is None else value


def _digits(ball: arb) -> str:
    return decimal_string(Fraction(0) if ball.contains(0) else dyadic_fraction(ball.mid()), DIGITS)
