"""Derivatives of a step by the package itself: differences of its exact steps."""

import numpy as np

from quasistatic_ref.errors import ContactError
from quasistatic_ref.lab.vectors.own.step import posed_case
from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.optional.derivatives.derivatives import derivatives

PARAMETERS = ("q", "q_bar_a", "tau", "mu_v", "mu_omega", "K_q", "h", "masses")


def own_derivative(case_input: Json) -> Json:
    """The answer of the layer `derivative`; reasons, which have other names here, are left out.

    So is a derivative by friction of zero, which cannot be smaller.
    """
    try:
        posed = posed_case(case_input)
    except ContactError:  # a step is refused whose normal is one of several
        return {"differentiable": False}
    mine = posed.mine
    n_a = posed.step.n_a
    rates = derivatives(posed.simulator, posed.q, posed.q_bar_a, posed.force, PARAMETERS)
    v = mine.v
    a = mine.v[:n_a]
    bodies = case_input["mechanism"]["bodies"]
    massive = np.array([mine.links[body["name"]] for body in bodies if "mass" in body], dtype=int)
    rubs, turns = (
        np.flatnonzero([pair[mu] > 0 for pair in case_input["pairs"]])
        for mu in ("mu_v", "mu_omega")
    )
    answer = {
        "dq_dq": rates.dq_dq[np.ix_(v, v)],
        "dq_dq_bar_a": rates.dq_dq_bar_a[np.ix_(v, a)],
        "dq_dtau": rates.dq_dtau[np.ix_(v, v)],
        "dq_dmu_v": rates.dq_dmu_v[np.ix_(v, rubs)],
        "dq_dmu_omega": rates.dq_dmu_omega[np.ix_(v, turns)],
        "dq_dK_q": rates.dq_dK_q[np.ix_(v, a)],
        "dq_dh": rates.dq_dh[v],
        "dq_dm": rates.dq_dmasses[np.ix_(v, massive)],
    }
    if any(np.isnan(value).any() for value in answer.values()):
        return {"differentiable": False}
    return {"differentiable": True, **{name: value.tolist() for name, value in answer.items()}}
