"""Layer 5: min 1/2 x'Hx - g'x subject to Ax >= b, its float64 numbers taken as they are.

lam and the working set are those of the cold run of the dual active-set method that adds the first
violated row; the plain program checks the conditions of the optimum in rationals. In second-order
cones, (F x + f)_0 >= |(F x + f)_1:3| for each block, the optimum is not rational: it is enclosed in
balls.
"""

from collections.abc import Sequence

import numpy as np
from flint import fmpq

from quasistatic_ref.certify.active_set import Combination, least_index
from quasistatic_ref.certify.certificate import Certificate
from quasistatic_ref.certify.degeneracy import Degeneracy, form_degeneracy
from quasistatic_ref.certify.exact import ExactOptimum, form_optimum
from quasistatic_ref.certify.failures import StepInfeasible
from quasistatic_ref.certify.form import MatrixForm
from quasistatic_ref.certify.working_set import fraction_point
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.program.optimum import is_optimum
from quasistatic_ref.lab.scenes.rigid import conic_step, program_step
from quasistatic_ref.lab.vectors.exact.conditioning import Bounds, bounds
from quasistatic_ref.lab.vectors.exact.enclosed import enclosed_optimum
from quasistatic_ref.lab.vectors.exact.entered import exact_case
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of, exact_slack
from quasistatic_ref.lab.vectors.exact.precision import rounded_results, short
from quasistatic_ref.lab.vectors.exact.rational import tolerance
from quasistatic_ref.lab.vectors.expected import Expected, Json, Tolerance
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.data import StepData

UNIQUE = 1e-6
"""Largest tolerance of lam, relative to its largest entry, at which its entries are compared."""
SMALLEST = ("smallest_inactive_slack", "smallest_active_multiplier")
FACTS = ("multipliers_unique", "differentiable", *SMALLEST)
"""What a certificate says of an optimum in addition to its working set."""
FLAGS = ("degenerate", "unique_multipliers", "differentiable")
FARKAS = 1e-9
"""Relative size of A'y at which y counts as a proof: solvers stop at 1e-8 to 1e-12."""


def expected(case_input: Json) -> Expected:
    """The exact optimum, correctly rounded; or a Farkas vector; or an enclosure."""
    if "second_order" in case_input:
        return enclosed_optimum(cone_step(case_input))
    form = form_of(case_input)
    optimum = form_optimum(form, (), least_index)
    if isinstance(optimum, Combination):
        return _infeasible(form, optimum)
    exact = _checked_optimum(case_input, form, optimum.working_set)
    slack = exact_slack(form, optimum.working_set)
    bound = bounds(form, optimum.working_set)
    facts = form_degeneracy(form, optimum.working_set)
    return Expected(
        output={
            "delta_q": optimum.delta_q.tolist(),
            "lam": optimum.lam.tolist(),
            "A_lam": optimum.net.tolist(),
            "slack": slack.tolist(),
            "certificate": _certificate(optimum, facts),
        },
        digits=short(rounded_results(lambda: exact)[1]),
        flags=flags_of(optimum, facts, slack, bound),
        tolerance=tolerances(bound),
    )


def own(case_input: Json) -> Json:
    """The package's answer, by :func:`quasistatic_ref.solve.solve.solve_step`."""
    from quasistatic_ref.solve.solve import solve_step
    from quasistatic_ref.step.standard_form import standard_form

    conic = "second_order" in case_input
    step = cone_step(case_input) if conic else step_of(case_input)
    try:
        solution = solve_step(step)
    except StepInfeasible as failure:
        return {"farkas": failure.farkas.y.tolist()}
    x = solution.delta_q
    if conic:
        form = standard_form(step)
        A, b = form.A, form.b  # of each block F x + f
    else:
        A = step.extra.A
        b = step.extra.b
    lam = solution.lam
    return {
        "delta_q": x.tolist(),
        "lam": lam.tolist(),
        "A_lam": (A.T @ lam).tolist(),
        "slack": (A @ x - b).tolist(),
    }


def matrices(case_input: Json) -> tuple[Array, Array, Array, Array]:
    """H (n, n), g (n,), A (m, n) and b (m,) of a case, in its units."""
    H, g, b = (np.array(case_input[key], dtype=np.float64) for key in ("H", "g", "b"))
    return H, g, np.array(case_input["A"], dtype=np.float64).reshape(len(b), len(g)), b


def form_of(case_input: Json) -> MatrixForm:
    """The program of a case without rounding."""
    return exact_form_of(*matrices(case_input))


def step_of(case_input: Json) -> StepData:
    """The same program as a step, in which form `verify` of the package re-verifies it."""
    return program_step(*matrices(case_input))


def cone_step(case_input: Json) -> StepData:
    """The same for second-order cones, each a contact with mu_v = mu_omega = 1; or InputError."""
    blocks = case_input["second_order"]
    H, g = (np.array(case_input[key], dtype=np.float64) for key in ("H", "g"))
    F = np.array([block["F"] for block in blocks]).reshape(len(blocks), 4, len(g))
    f = np.array([block["f"] for block in blocks]).reshape(len(blocks), 4)
    if f[:, 1:].any():
        problem = "only its first entry may differ from 0: phi of a contact"
        raise InputError(problem, field="second_order.f", value=f.tolist())
    return conic_step(H, g, F, f[:, 0])


def claimed_certificate(case_input: Json, output: Json, step: StepData) -> Certificate:
    """The certificate of an output about a step, as `verify` takes it."""
    written = output["certificate"]
    if "second_order" in case_input:
        return Certificate(kind="enclosure", error_bound=written["error_bound"], step=step)
    active = tuple((0, i) for i in written["working_set"])  # of the step's own rows
    facts = {name: written[name] for name in (*FACTS, "error_bound")}
    return Certificate(kind=written["kind"], active=active, **facts, step=step)


def tolerances(bound: Bounds) -> dict[str, Tolerance]:
    """Tolerances of the fields of an optimum."""
    why = (
        "rounding of the data and of the KKT system, times its componentwise condition; "
        "at least 8 roundings of the unconstrained step, in the H norm"
    )
    return {
        "delta_q": tolerance(bound.x, why),
        "lam": tolerance(bound.lam, why),
        "A_lam": tolerance(bound.net, "that of delta_q, times H"),
        "slack": tolerance(bound.slack, "that of delta_q, times A"),
    }


def _checked_optimum(
    case_input: Json, form: MatrixForm, working: Sequence[int]
) -> dict[str, list[fmpq]]:
    """delta_q and A'lam of a working set, after the plain program looked at their conditions."""
    exact = fraction_point(form, working)
    x, net, lam = map(exact.in_fractions, (exact.x, exact.net.entries(), exact.y))
    every = [fmpq(0)] * form.m
    for row, value in zip(working, lam, strict=True):
        every[row] = value
    assert is_optimum(exact_case(case_input), x, every)
    return {"delta_q": x, "A_lam": net}


def _certificate(optimum: ExactOptimum, facts: Degeneracy) -> Json:
    return {
        "kind": "exact",
        "working_set": list(optimum.working_set),
        **facts._asdict(),
        "smallest_active_multiplier": optimum.smallest_active_multiplier,
        "error_bound": 0.0,
    }


def flags_of(
    optimum: ExactOptimum, facts: Degeneracy, slack: Array, bound: Bounds
) -> dict[str, bool]:
    """What may be compared, and what is delicate about an optimum.

    Ties between rows that float64 data split in the last place count as ties: a solver cannot see
    the difference.
    """
    idle = np.delete(slack, list(optimum.working_set))
    pressed = optimum.lam[list(optimum.working_set)]
    weak = bool((pressed <= float(bound.lam)).any())
    tied = bool((idle <= float(bound.slack)).any())
    known = float(bound.lam) <= UNIQUE * float(pressed.max(initial=1.0))
    return {
        "infeasible": False,
        "degenerate": tied or weak,
        "unique_multipliers": facts.multipliers_unique and known and not tied,
        "differentiable": facts.differentiable,
    }


def _infeasible(form: MatrixForm, proof: Combination) -> Expected:
    """A combination y >= 0 of the rows with A'y = 0 and b'y > 0, its largest entry being 1."""
    largest_y = max(proof.y.values())
    why = "any y >= 0 whose A'y is that small beside |A|'y and b'y proves the same"
    y = [proof.y.get(i, fmpq(0)) / largest_y for i in range(form.m)]
    return Expected(
        output={
            "farkas": rounded_results(lambda: y)[0],
            "certificate": {"kind": "exact", "farkas": [str(v) for v in y]},
        },
        flags={"infeasible": True, **dict.fromkeys(FLAGS, False)},
        tolerance={"farkas": Tolerance(FARKAS, why)},
    )
