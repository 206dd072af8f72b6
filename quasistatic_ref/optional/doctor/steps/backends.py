"""Backends that fail, or have fewer digits than were asked for."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from math import log10
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.optional.doctor.frame.run import Run
from quasistatic_ref.optional.doctor.texts import finding
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.solve.backends import NONE, QPSOLVERS
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData, differences
from quasistatic_ref.step.standard_form import standard_form

if TYPE_CHECKING:
    from quasistatic_ref.solve.step_problem import StepProblem

SAME = 1e-9
"""Largest difference of sums that are the same but for rounding, over the sums of sizes [-]."""


def backend_failures(run: Run) -> Iterator[Finding]:
    """Steps whose exact optimum the backend missed.

    An accuracy of 10^-2k gives k digits of delta_q: by strong convexity the error is the square
    root of twice the gap. An enclosure may be no nearer than the answer, and asks for none.
    """
    simulator = run.simulator
    polyhedral = cone(simulator.cone).polyhedral
    wanted = -log10(simulator.accuracy) / 2 if polyhedral else 0.0
    unanswered = np.isin(np.arange(run.steps), run.trajectory.header.unanswered)
    short = run["digits"] < wanted  # NaN without an answer, or where the optimum is not known
    if simulator.backend == NONE or not (unanswered | short).any():
        return
    others = other_programs(run, np.flatnonzero(unanswered | short))
    if others:
        unanswered[others] = False
        short[others] = False
        cause = (
            f"{simulator.backend} solved another program than Eqs. (8) and (13) in {len(others)} "
            f"of {run.steps} steps, the first of them step {others[0]}"
        )
        remedy = (
            "compare the page, step/problem.py, with step/standard_form.py: one of them has been "
            "changed"
        )
        yield finding("failing-backend", cause, remedy, other=len(others), step=others[0])
    missed = np.flatnonzero(unanswered | short)
    if not missed.size:
        return
    first = int(missed[0])
    numbers = {"failed": int(unanswered.sum()), "short": int(short.sum()), "step": first}
    fewer = f"had fewer than the {wanted:g} digits that were asked for in {numbers['short']}"
    says = [f"failed in {numbers['failed']} of {run.steps} steps"] * bool(numbers["failed"])
    says += [fewer] * bool(numbers["short"])
    exact = (run["certificate"][missed] == "exact").all()
    other = "the exact method" if exact else "another backend or the exact method"
    cause = f"{simulator.backend} {' and '.join(says)}, the first of them step "
    cause += f"{first}; {other} solved them"
    others_able = "clarabel", "daqp" if polyhedral else "scs"
    able = " or ".join(name for name in others_able if _solves(run, name, first, wanted))
    remedy = "check masses, lengths and stiffness, or leave the steps to the exact method"
    if able:
        remedy = f"choose another backend than {simulator.backend}, such as {able}"
    yield finding("failing-backend", cause, remedy, **numbers)


def other_programs(run: Run, some: Indices) -> list[int]:
    """Those of some steps whose page in CVXPY is not the program that is proved.

    Pages differ where step/problem.py is edited, or where a problem of a user's own stands in the
    solver. One place shows what another leaves out: where nothing slips, friction is in no row.
    """
    simulator = run.simulator
    if simulator.solver is None or simulator.solver.interface != "cvxpy" or not run.small:
        return []
    from quasistatic_ref.solve.step_problem import CvxpySolver, StepProblem  # CVXPY takes its time

    if not isinstance(simulator.solver, CvxpySolver) or not cone(simulator.cone).polyhedral:
        return []
    page = simulator.solver.problem
    others: list[int] = []
    for k in some.tolist():
        step = run.step(k)
        if differences(page.template, step):
            page = StepProblem(step)
        page.fill(step)
        places = run.trajectory.delta_q[k], np.linspace(1.0, 2.0, step.n_v)
        if not all(is_program_of(page, step, delta_q) for delta_q in places):
            others.append(k)
    return others


def is_program_of(page: StepProblem, step: StepData, delta_q: Array) -> bool:
    """Whether rows and cost of a page, filled with a step, have the step's values at a delta_q.

    What is beyond float64 shows no difference.

    Parameters
    ----------
    page : StepProblem
    step : StepData
    delta_q : ndarray, shape (n_v,)
        [m, rad].
    """
    rows = [*page.contact_rows, *page.extra]
    if [row.id for row in page.problem.constraints] != [row.id for row in rows]:
        return False
    h = step.h
    H, g, A, b = standard_form(step)
    a_a, a_u = np.split(delta_q / h**2, [step.n_a])
    page.a_a.value = a_a
    page.a_u.value = a_u
    length = np.abs(delta_q)
    with np.errstate(over="ignore", invalid="ignore"):
        of_contacts = np.zeros(step.mask.shape)
        for i, row in zip(np.flatnonzero(step.mask.any(axis=0)), page.contact_rows, strict=True):
            of_contacts[step.mask[:, i], i] = -(h**2) * row.expr.value
        of_extra = [-(h**2) * row.expr.value for row in page.extra]
        slacks = np.concatenate([of_contacts[step.mask], *of_extra])
        off = np.abs(slacks - (A @ delta_q - b))
        cost = delta_q @ H @ delta_q / 2 - g @ delta_q
        off_cost = abs(h**3 * float(page.problem.objective.value) - cost)
        differs = off > SAME * (np.abs(A) @ length + np.abs(b)).max(initial=0.0)
        costs_differ = off_cost > SAME * (length @ np.abs(H) @ length / 2 + np.abs(g) @ length)
    return not (differs.any() or costs_differ)


def _solves(run: Run, name: str, k: int, digits: float) -> bool:
    """Whether a backend is not the run's, and has some digits of step k if that may be solved."""
    simulator = run.simulator
    if name == simulator.backend.removeprefix(QPSOLVERS):
        return False
    if not run.small or simulator.law != CONVEX or simulator.extension is not None:
        return True
    with suppress(QuasistaticError):
        solved = solve_step(run.step(k), name, accuracy=simulator.accuracy).statistics
        return solved.digits is not None and solved.digits >= digits
    return False
