"""The exact answer of a problem, or an exact proof that there is none."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.certify.failures import StepInfeasible
from quasistatic_ref.certify.groups import group_steps
from quasistatic_ref.certify.optimum import optimum_by_groups
from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.exact.minimiser import Minimiser
from quasistatic_ref.exact.program import ExactProgram
from quasistatic_ref.lab.made_steps.rigid import program_step
from quasistatic_ref.lab.study.problems.problem import EXACT, Answer
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.standard_form import StandardForm

NONE = np.zeros(0)


def exact_answer(form: StandardForm, warm: Sequence[int] = ()) -> Answer:
    """The exact solution of a quadratic program, or an exact proof that it has none.

    Parts that neither H nor a row couples are solved one by one.

    Parameters
    ----------
    form : StandardForm
        Any units.
    warm : sequence of int
        Rows that the exact method starts from. From none a part of 60 coordinates takes 0.2 s, and
        one of 150 takes 12 s.
    """
    step = program_step(*form)
    try:
        parts = group_steps(step)
        optimum = optimum_by_groups(step, parts, [group.within(warm) for group, _ in parts])
    except StepInfeasible as none:
        farkas = {i: y for i, y in enumerate(none.farkas.exact) if y != "0"}
        return Answer(EXACT, 0.0, NONE, NONE, NONE, NONE, farkas)
    slack = np.zeros(step.m)
    for group, part in parts:
        slack[group.rows] = exact_slack(StepProgram(part), group.within(optimum.working_set))
    return Answer(EXACT, 0.0, optimum.delta_q, optimum.net, slack, optimum.lam, {})


def exact_slack(form: ExactProgram, working_set: Sequence[int]) -> Array:
    """A x - b at the minimiser on a working set, each entry rounded correctly, shape (m,) [m].

    Parameters
    ----------
    form : ExactProgram
    working_set : sequence of int
        Independent rows.
    """
    minimiser = Minimiser(form, tuple(working_set))
    inactive = minimiser.inactive
    slack = np.zeros(form.m)
    slack[inactive] = minimiser.rounded(lambda m: form.slacks(inactive.tolist(), m.z))
    return slack
