"""``StepProblem.solve``: a backend's answer to the page's step, by way of natural units."""

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
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
    answer = solve_step(step, name.lower(), accuracy=accuracy, certify="off")
    page.delta_q_a.save_value(answer.delta_q[: step.n_a])
    page.delta_q_u.save_value(answer.delta_q[step.n_a :])
    if cone(step.cone).polyhedral:
        of_rows = np.zeros(step.mask.shape)
        of_rows[step.mask] = answer.lam
        present = np.flatnonzero(step.mask.any(axis=0)).tolist()
        for row, i in zip(page.contact_rows, present, strict=True):
            row.save_dual_value(of_rows[step.mask[:, i], i])
    return answer.delta_q
