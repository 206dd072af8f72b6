"""What single options of backends are worth on every step of both bunny_grasp runs.

``python -m validation.make.options_of_backends`` (some minutes) prints a CSV: for each set of
options the steps that the backend did not solve, with and without torsional friction, and the worst
and the median of its correct digits on those that it solved. Backends are called through qpsolvers,
cold. What was learned stands in docs/conventions.md, and the options in ``solve/backends.py``.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import numpy as np
from tqdm import tqdm

from quasistatic_ref.lab.digits import correct_digits
from quasistatic_ref.lab.grasp import CASES
from quasistatic_ref.optional.qpsolvers.through_qpsolvers import qpsolvers_reply
from quasistatic_ref.solve.backends import BACKENDS, Options
from quasistatic_ref.solve.scaled import DenseStep
from quasistatic_ref.solve.units import from_natural, within_reach
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import standard_form
from validation.make.digits_of_backends import steps_of

RESULTS = Path(__file__).parents[1] / "results" / "options_of_backends.csv"
RAW, NATURAL = "raw", "natural"
TIGHTEST = 1e-12
GAPS = {
    "clarabel": ("tol_gap_abs", "tol_gap_rel"),
    "piqp": ("eps_duality_gap_abs", "eps_duality_gap_rel"),
}
REGULARISATION = "reg_lower_limit", "reg_finetune_lower_limit"


@dataclass(frozen=True)
class Worth:
    """One set of options of a backend on all steps.

    Parameters
    ----------
    backend, units, options : str
    unsolved_with, unsolved_without : int
        Steps that it did not solve, with and without torsional friction.
    worst, median : float
        Correct digits where it did [-].
    """

    backend: str
    units: str
    options: str
    unsolved_with: int
    unsolved_without: int
    worst: float
    median: float


def combinations() -> Iterator[tuple[str, str, str, Options]]:
    """Backend, units, what is special about the options, and the options."""
    for name, options in GAPS.items():
        for gap in (1e-12, 1e-14):
            own = BACKENDS[name].first(TIGHTEST) | dict.fromkeys(options, gap)
            yield name, NATURAL, f"gap {gap:g}", own
    for options in BACKENDS["clarabel"].attempts(TIGHTEST):
        special = f"static regularisation {options['static_regularization_constant']:g}"
        yield "clarabel", NATURAL, special, options
    piqp = BACKENDS["piqp"].first(TIGHTEST)
    own = {name: value for name, value in piqp.items() if name not in REGULARISATION}
    yield "piqp", NATURAL, "its own regularisation", own
    yield "piqp", NATURAL, "less regularisation", piqp
    for accuracy in (1e-10, 1e-11, 1e-12):
        fixed, adaptive, _ = BACKENDS["osqp"].attempts(accuracy)
        yield "osqp", NATURAL, f"fixed rho at {accuracy:g}", fixed
        yield "osqp", NATURAL, f"adaptive rho at {accuracy:g}", adaptive
    yield "highs", RAW, "defaults", {}
    yield "highs", NATURAL, "defaults", {}
    yield "highs", NATURAL, "tolerances 1e-10", BACKENDS["highs"].first(TIGHTEST)
    yield "highs", NATURAL, "no regularisation", {"qp_regularization_value": 0.0}
    yield "proxqp", NATURAL, "at 1e-12", BACKENDS["proxqp"].first(TIGHTEST)


def answered(step: StepData, units: str, backend: str, options: Options) -> Array | None:
    """The delta_q that a backend gives [m, rad]; None if it does not solve the step."""
    if units == RAW:
        reply = qpsolvers_reply(standard_form(step), backend, options)
        return reply.x if reply.solved else None
    scaled = DenseStep(step)
    reply = qpsolvers_reply(standard_form(within_reach(scaled.natural)), backend, options)
    if reply.x is None or not reply.solved:
        return None
    return from_natural(reply.x, np.zeros(0), scaled.units)[0]


def measured() -> Iterator[Worth]:
    """One record for each set of options."""
    runs = [steps_of(own) for own in CASES.values()]  # with torsion, without
    for backend, units, special, options in tqdm(list(combinations())):
        unsolved, digits = [0, 0], []
        for case, steps in enumerate(runs):
            for step, x in steps:
                delta_q = answered(step, units, backend, dict(options))
                if delta_q is None:
                    unsolved[case] += 1
                else:
                    digits.append(correct_digits(step, delta_q, x).delta_q)
        worst, median = (float(f"{f(digits):.2f}") for f in (np.min, np.median))
        yield Worth(backend, units, special, *unsolved, worst, median)


def records_read() -> list[Worth]:
    """The committed results."""
    kinds = {"unsolved_with": int, "unsolved_without": int, "worst": float, "median": float}
    with RESULTS.open(newline="") as file:
        return [
            Worth(**{name: kinds.get(name, str)(text) for name, text in row.items()})
            for row in csv.DictReader(file)
        ]


def main() -> None:
    """Print the table."""
    table = csv.DictWriter(sys.stdout, [f.name for f in fields(Worth)], lineterminator="\n")
    table.writeheader()
    for record in measured():
        table.writerow(asdict(record))
        sys.stdout.flush()


if __name__ == "__main__":
    main()
