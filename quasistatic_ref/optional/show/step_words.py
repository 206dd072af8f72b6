"""A step and its answer in words: what ``repr`` and a notebook show of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.optional.show.show import Page, Row, counted, direction, number
from quasistatic_ref.step.cones import cone

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from quasistatic_ref.certify.certificate import Certificate
    from quasistatic_ref.certify.solution import StepSolution
    from quasistatic_ref.step.contacts import Contacts
    from quasistatic_ref.step.data import Array, Extra, StepData
    from quasistatic_ref.step.problem import StepProblem
    from quasistatic_ref.step.standard_form import StandardForm

CONTACT = ("contact", "gap [m]", "normal", "mu_v", "mu_omega [m]", "rows")
ARRAY = ("array", "shape", "largest entry", "NaN")
BEARING = 1e-3
"""A contact bears load above this share of the largest normal force [-]."""
FORCE = ("f_d1 [N]", "f_d2 [N]", "f_n [N]", "tau_n [N m]", "active rows")


def extra_page(extra: Extra) -> Page:
    """Rows of the user's own, by name."""
    rows = [(name, number(b)) for name, b in zip(extra.names, extra.b, strict=True)]
    title = f"Extra: {counted(len(rows), 'row')} A delta_q >= b"
    return title, [], ("row", "b"), rows


def certificate_page(certificate: Certificate) -> Page:
    """What is claimed of an answer."""
    return f"Certificate: {certificate.kind}", certificate_facts(certificate), (), ()


def certificate_facts(certificate: Certificate) -> list[str]:
    """What is claimed of an answer besides the kind of its certificate, one sentence each."""
    residual = max(certificate.residuals.values(), default=None)
    facts = [f"worst residual {number(residual)}, error bound {number(certificate.error_bound)}"]
    known = certificate.multipliers_unique, certificate.differentiable
    if None not in known:
        unique, smooth = ("" if one else "not " for one in known)
        facts.append(
            f"{counted(len(certificate.active), 'active row')}; multipliers "
            f"{unique}unique, delta_q {smooth}differentiable"
        )
    return facts


def contact_rows(contacts: Contacts) -> list[Row]:
    """Of each contact: its name, gap, normal and friction."""
    return [
        (name, number(phi), direction(n), number(mu_v), number(mu_omega), str(rows))
        for name, phi, n, mu_v, mu_omega, rows in zip(
            contacts.name, contacts.phi, contacts.n, contacts.mu_v, contacts.mu_omega,
            contacts.rows, strict=True,
        )
    ]  # fmt: skip


def force_rows(solution: StepSolution) -> list[Row]:
    """Of each contact: its wrench and the names of its active rows, where they are known."""
    names = cone(solution.cone).row_names
    active = solution.certificate.active
    known = solution.certificate.kind == "exact"
    of_contact: dict[int, list[str]] = {}
    for j, i in active:
        of_contact.setdefault(j, []).append(names[i] if i < len(names) else str(i))
    return [
        (*map(number, wrench), " ".join(of_contact.get(j, ["none"])) if known else "not known")
        for j, wrench in enumerate(solution.wrench)
    ]


def bearing_first(rows: Sequence[Row], f_n: Array) -> list[Row]:
    """Rows of contacts: first those that bear load, then the others, each in their order.

    Parameters
    ----------
    rows : sequence of Row
    f_n : ndarray, shape (n_c,)
        Normal forces [N].
    """
    idle = f_n <= BEARING * f_n.max(initial=0.0)
    return [rows[j] for j in np.argsort(idle, kind="stable")]


def array_rows(arrays: Mapping[str, Array]) -> list[Row]:
    """Of each of `arrays`, any shapes [-]: name, shape, largest magnitude, number of NaN."""
    return [
        (name, " x ".join(map(str, array.shape)),
         number(np.abs(array[np.isfinite(array)]).max(initial=0.0)),
         str(np.count_nonzero(np.isnan(array))))
        for name, array in arrays.items()
    ]  # fmt: skip


def form_page(form: StandardForm) -> Page:
    """A quadratic program: its size, and its arrays."""
    rows, n_v = form.A.shape
    title = f"StandardForm: {counted(n_v, 'coordinate')}, {counted(rows, 'row')}"
    facts = ["minimise 1/2 x' H x - g' x subject to A x >= b"]
    return title, facts, ARRAY[:3], [row[:3] for row in array_rows(form._asdict())]


def problem_page(problem: StepProblem) -> Page:
    """A compiled problem: the kind of its steps, and its parameters."""
    parameters = problem.parameters.items()
    shapes = [(name, " x ".join(map(str, parameter.shape))) for name, parameter in parameters]
    title, *_ = step_page(problem.template)
    return title.replace("StepData", "StepProblem"), [], ("parameter", "shape"), shapes


def step_page(step: StepData) -> Page:
    """A step: what moves, and its contacts."""
    title = (
        f"StepData: h = {step.h:g} s, {counted(step.n_v, 'coordinate')} ({step.n_a} actuated), "
        f"{counted(step.contacts.n_c, 'contact')}, {counted(int(step.offsets[-1]), 'row')}, "
        f"cone {step.cone}"
    )
    facts = [f"{counted(len(step.extra.names), 'further row')}"] if step.extra.names else []
    return title, facts, CONTACT, contact_rows(step.contacts)


def contacts_page(contacts: Contacts) -> Page:
    """Contacts: gap, normal and friction of each."""
    title = f"Contacts: {counted(contacts.n_c, 'contact')}, {counted(contacts.n_v, 'coordinate')}"
    return title, [], CONTACT, contact_rows(contacts)


def solution_page(solution: StepSolution) -> Page:
    """An answer: its certificate, and the force and active rows of each contact."""
    certificate = solution.certificate
    largest = float(np.abs(solution.delta_q).max(initial=0.0))
    title = (
        f"StepSolution: {counted(len(solution.delta_q), 'coordinate')}, largest |delta_q_i| "
        f"{number(largest)}; backend {solution.backend}, certificate: {certificate.kind}"
    )
    rows = [(str(j), *row) for j, row in enumerate(force_rows(solution))]
    shown = bearing_first(rows, solution.wrench[:, 2])
    return title, certificate_facts(certificate), ("contact", *FORCE), shown
