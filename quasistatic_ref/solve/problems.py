"""What may be kept between steps of one kind, and which suits a step."""

from __future__ import annotations

from quasistatic_ref.solve.cone_problem import cone_problem
from quasistatic_ref.solve.engines import NATIVE
from quasistatic_ref.solve.native import NativeProblem
from quasistatic_ref.solve.sparse import ADAPTERS, SparseProblem
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.problem import StepProblem

Problem = StepProblem | NativeProblem | SparseProblem


def problem_for(step: StepData, engine: str, backend: str) -> Problem:
    """A new problem for steps like this one, sparse if its contacts are in blocks."""
    if engine != NATIVE:
        return cone_problem(step)
    if step.contacts.blocks is not None:
        return SparseProblem(step, backend)
    return NativeProblem(step, backend)


def may_be_sparse(engine: str, backend: str, certify: str) -> bool:
    """Whether large steps may take the sparse road: natively, and nothing is certified exactly."""
    return engine == NATIVE and backend in ADAPTERS and certify != "full"
