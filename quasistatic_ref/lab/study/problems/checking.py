"""Every answer of a set proved again, without a solver."""

import numpy as np
from scipy.sparse import csc_matrix

from quasistatic_ref.certify.exact import ExactOptimum, form_optimum
from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.lab.scenes.contacts import contacts_of, no_contacts
from quasistatic_ref.lab.scenes.rigid import actuated_step
from quasistatic_ref.lab.study.problems.problem import BOUNDED, SOCP, Problem
from quasistatic_ref.lab.vectors.exact.forms import exact_form_of
from quasistatic_ref.optional.ellipsoid.enclosure import enclosure
from quasistatic_ref.optional.large.float_bound import FloatBound
from quasistatic_ref.optional.large.sizes import term_sizes
from quasistatic_ref.step.cones import ELLIPSOID
from quasistatic_ref.step.data import Extra, StepData
from quasistatic_ref.step.standard_form import StandardForm


def refutation(one: Problem) -> str | None:
    """What is wrong with the answer of a problem; None if it is proved again.

    Parameters
    ----------
    one : Problem
    """
    if one.answer.farkas:
        y = [one.answer.farkas.get(i, "0") for i in range(len(one.b))]
        return farkas_refutation(row_step(one.form), y)
    if one.facts["kind"] == SOCP:
        return _not_enclosed(one)
    if one.answer.kind == BOUNDED:
        return _not_bounded(one)
    warm = np.flatnonzero(one.answer.lam).tolist()
    found = form_optimum(exact_form_of(*one.form), warm)
    if not isinstance(found, ExactOptimum):
        return "it has no solution"
    parts = {"x": found.delta_q, "net": found.net, "slack": found.slack}
    wrong = [
        name for name, v in parts.items() if v.tobytes() != getattr(one.answer, name).tobytes()
    ]
    return f"{' and '.join(wrong)} have other bits" if wrong else None


def row_step(form: StandardForm) -> StepData:
    """The step whose standard form is a given quadratic program: h = 1, K_q = H, rows as extra."""
    n = len(form.g)
    rows = Extra(tuple(f"row {i}" for i in range(len(form.b))), form.A, form.b)
    return actuated_step(form.H, form.g, np.zeros(n), no_contacts(n), 1.0).replace(extra=rows)


def cone_step(one: Problem) -> StepData:
    """The step in the ellipsoid, friction being 1, whose blocks of rows a problem has."""
    A = one.A.toarray().reshape(-1, 4, len(one.g))
    phi = -one.b.reshape(-1, 4)[:, 0]
    own_frames = np.tile(np.eye(3), (len(A), 1, 1))
    contacts = contacts_of(phi, own_frames, A[:, [1, 2, 0, 3]], 1.0, 1.0, 6)
    H = one.H.toarray()
    return actuated_step(H, one.g, np.zeros(len(one.g)), contacts, 1.0).replace(cone=ELLIPSOID)


def _not_enclosed(one: Problem) -> str | None:
    again = enclosure(cone_step(one))
    if again is None:
        return "its answer cannot be enclosed"
    norm = energy_norm(one.H.toarray())
    far = norm.of_displacement(again.delta_q - one.answer.x) / norm.of_impulse(one.g)
    close = far <= 2 * (again.error + one.answer.error) + 1e-16
    return None if close else f"x is off by {far:.1g}"


def _not_bounded(one: Problem) -> str | None:
    natural = one.natural
    H = csc_matrix(natural.H)
    A = csc_matrix(natural.A)
    form = StandardForm(H, natural.g, A, natural.b)
    sizes = term_sizes(abs(A), np.abs(natural.g))
    error = FloatBound(H).error(form, sizes, natural.answer.x, natural.answer.lam)
    worse = error > 1.01 * one.answer.error
    return f"its error is bounded by {error:.1g} only" if worse else None
