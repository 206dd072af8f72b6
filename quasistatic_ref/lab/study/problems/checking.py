"""Every answer of a set proved again, without a solver."""

import numpy as np

from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.lab.made_steps.rigid import conic_step, program_step
from quasistatic_ref.lab.study.problems.answers import exact_answer
from quasistatic_ref.lab.study.problems.problem import SOCP, Problem
from quasistatic_ref.optional.ellipsoid.enclosure import enclosure


def refutation(one: Problem) -> str | None:
    """What is wrong with the answer of a problem; None if it is proved again.

    Parameters
    ----------
    one : Problem
    """
    if one.answer.farkas:
        y = [one.answer.farkas.get(i, "0") for i in range(len(one.b))]
        return farkas_refutation(program_step(*one.form), y)
    if one.facts["kind"] == SOCP:
        return _not_enclosed(one)
    warm = np.flatnonzero(one.answer.lam).tolist()
    again = exact_answer(one.form, warm)
    if again.farkas:
        return "it has no solution"
    wrong = [
        name
        for name in ("x", "net", "slack")
        if getattr(again, name).tobytes() != getattr(one.answer, name).tobytes()
    ]
    return f"{' and '.join(wrong)} have other bits" if wrong else None


def _not_enclosed(one: Problem) -> str | None:
    H, g, A, b = one.form
    again = enclosure(conic_step(H, g, A.reshape(-1, 4, len(g)), -b.reshape(-1, 4)[:, 0]))
    if again is None:
        return "its answer cannot be enclosed"
    norm = energy_norm(H)
    far = norm.of_displacement(again.delta_q - one.answer.x) / norm.of_impulse(g)
    close = far <= 2 * (again.error + one.answer.error) + 1e-16
    return None if close else f"x is off by {far:.1g}"
