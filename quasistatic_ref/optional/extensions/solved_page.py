"""``StepProblem.solve``: a backend's answer to the page's step, by way of natural units."""

import numpy as np

from quasistatic_ref.solve.backends import NONE
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.solve.units import in_si
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.problem import StepProblem


def solved_page(page: StepProblem, step: StepData, name: str, accuracy: float) -> Array:
    """The backend's answer, which the page then holds; as :meth:`.StepProblem.solve`.

    Parameters
    ----------
    page : StepProblem
    step : StepData
        That it is filled with, SI units.
    name : str
        Of the backend.
    accuracy : float
        In natural units [-].

    Returns
    -------
    ndarray, shape (n_v,)
    """
    solver = solver_for(step, name.lower() if name != NONE else name)
    both = solver.in_both_units(step)
    answer = solver.answer(both, accuracy)
    delta_q, lam = in_si(answer.natural_delta_q, answer.natural_lam, both.units)
    page.delta_q_a.save_value(delta_q[: step.n_a])
    page.delta_q_u.save_value(delta_q[step.n_a :])
    if cone(step.cone).polyhedral:
        of_rows = np.zeros(step.mask.shape)
        of_rows[step.mask] = lam[: len(lam) - len(step.extra.names)]
        present = np.flatnonzero(step.mask.any(axis=0)).tolist()
        for row, i in zip(page.contact_rows, present, strict=True):
            row.save_dual_value(of_rows[step.mask[:, i], i])
    return delta_q
