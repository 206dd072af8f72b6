"""Optima proved whole and by group, and steps of several groups."""

from quasistatic_ref import StepIllPosed, StepInfeasible
from quasistatic_ref.certify.active_set import Combination
from quasistatic_ref.certify.degeneracy import form_degeneracy, step_degeneracy
from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.certify.optimum import form_optimum, step_optimum
from quasistatic_ref.certify.step_form import StepForm
from tests.made import bits

SAME = ("delta_q", "net")
"""What of an optimum no choice is left of, beside what its rows without slack say."""


def faults(step):
    """In what the optimum by group is not that of the whole; empty if it is."""
    whole = form_optimum(StepForm(step))
    try:
        grouped = step_optimum(step)
    except StepInfeasible as failure:
        if not isinstance(whole, Combination):
            return ["infeasible by group only"]
        reason = farkas_refutation(step, failure.farkas.exact)
        return [] if reason is None else [reason]
    except StepIllPosed as failure:
        if isinstance(whole, Combination):
            return ["feasible by group only"]
        return [] if failure.delta_q.tobytes() == whole.delta_q.tobytes() else ["delta_q"]
    if isinstance(whole, Combination):
        return ["feasible by group only"]
    facts = form_degeneracy(StepForm(step), whole.working_set)
    names = (*SAME, "lam") if facts.multipliers_unique else SAME
    unlike = [name for name in names if bits(getattr(grouped, name)) != bits(getattr(whole, name))]
    by_group = step_degeneracy(step, grouped.working_set)
    return unlike if bits(by_group) == bits(facts) else [*unlike, "degeneracy"]
