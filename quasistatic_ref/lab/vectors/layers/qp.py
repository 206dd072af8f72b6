"""Layer 5: min 1/2 x'Hx - g'x subject to Ax >= b, its float64 numbers taken as they are.

In second-order cones, (F x + f)_0 >= |(F x + f)_1:3| for each block, the optimum is not rational:
the package encloses it.
"""

import numpy as np

from quasistatic_ref.certify.failures import StepInfeasible
from quasistatic_ref.certify.groups import group_steps
from quasistatic_ref.certify.optimum import optimum_by_groups
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.made_steps.rigid import conic_step, program_step
from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.data import StepData

UNIQUE = 1e-6
"""Largest tolerance of lam, relative to its largest entry, at which its entries are compared."""


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


def exact_optimum(H: Array, g: Array, A: Array, b: Array) -> tuple[Array | None, Array]:
    """Exact x and lam of min 1/2 x'Hx - g'x s.t. Ax >= b; or None and a Farkas vector.

    Parameters
    ----------
    H : ndarray, shape (n, n)
    g : ndarray, shape (n,)
    A : ndarray, shape (m, n)
    b : ndarray, shape (m,)

    Returns
    -------
    x : ndarray, shape (n,), or None
    lam : ndarray, shape (m,)
    """
    step = program_step(H, g, A, b)
    parts = group_steps(step)
    try:
        optimum = optimum_by_groups(step, parts, [()] * len(parts))
    except StepInfeasible as failure:
        return None, failure.farkas.y
    return optimum.delta_q, optimum.lam


def step_of(case_input: Json) -> StepData:
    """The program of a case as a step, which the package's `verify` takes."""
    return program_step(*matrices(case_input))


def cone_step(case_input: Json) -> StepData:
    """A case's program with second-order cones as a step, or InputError: cones are contacts."""
    blocks = case_input["second_order"]
    H, g = (np.array(case_input[key], dtype=np.float64) for key in ("H", "g"))
    F = np.array([block["F"] for block in blocks]).reshape(len(blocks), 4, len(g))
    f = np.array([block["f"] for block in blocks]).reshape(len(blocks), 4)
    if f[:, 1:].any():
        problem = "only its first entry may differ from 0: phi of a contact"
        raise InputError(problem, field="second_order.f", value=f.tolist())
    return conic_step(H, g, F, f[:, 0])
