"""Steps, contacts and loads as cases hold them."""

import numpy as np

from quasistatic_ref.lab.scenes.contacts import NUMBERS
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers.rows import by_contact
from quasistatic_ref.step.data import Array, Contacts, StepData
from quasistatic_ref.step.standard_form import standard_form

LOADED = ("n", "d1", "d2", "mu_v", "mu_omega", "rows")
PLACE = ("alpha_body", "beta_body", "alpha", "beta")


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


def rows_input(at: Contacts, cone: str) -> Json:
    """The input of a case of the layer `rows`."""
    return {"cone": cone, "contacts": contact_entries(at, NUMBERS)}


def wrench_input(at: Contacts, cone: str, h: float, lam: Array, points: Json, bodies: Json) -> Json:
    """The input of a case of the layer `wrench`.

    Parameters
    ----------
    at : Contacts
    cone : str
    h : float
        [s].
    lam : ndarray, shape (m,)
        Contact-major [N s].
    points : list of dict
        The fields of PLACE, for each contact.
    bodies : dict
        Point of each body about which torques are taken.
    """
    entries = contact_entries(at, LOADED)
    parts = by_contact(lam.tolist(), cone, entries)
    for entry, point, part in zip(entries, points, parts, strict=True):
        entry |= {**point, "lam": part}
    return {"h": h, "cone": cone, "contacts": entries, "bodies": bodies}
