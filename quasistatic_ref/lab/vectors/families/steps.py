"""Steps and contacts as cases hold them."""

import numpy as np

from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.step.data import Contacts, StepData
from quasistatic_ref.step.standard_form import standard_form


def contact_entries(at: Contacts, keys: tuple[str, ...]) -> Json:
    """The contacts as a case holds them: a list of tables with these fields."""
    return [{key: getattr(at, key)[j].tolist() for key in keys} for j in range(at.n_c)]


def program(given: StepData) -> Json:
    """H, g, A, b of a step, in float64, as a case holds them; second-order cones likewise."""
    form = standard_form(given)
    H = form.H.tolist()
    g = form.g.tolist()
    if given.cone != "ellipsoid":
        return {"H": H, "g": g, "A": form.A.tolist(), "b": form.b.tolist()}
    at = given.contacts
    torsion = np.where(at.rows == 6, at.mu_omega, 0.0)
    mu = np.stack([np.ones(at.n_c), at.mu_v, at.mu_v, torsion], axis=1)
    F = form.A.reshape(at.n_c, 4, -1) * mu[:, :, None]
    blocks = [
        {"F": F_j.tolist(), "f": [phi, 0.0, 0.0, 0.0]}
        for F_j, phi in zip(F, at.phi.tolist(), strict=True)
    ]
    return {"H": H, "g": g, "second_order": blocks}
