"""A step and its answer in words: what ``repr`` and a notebook show of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.optional.show.show import Page, Row, counted, direction, number
from quasistatic_ref.step.cones import cone

if TYPE_CHECKING:
    from quasistatic_ref.certify.solution import Certificate, StepSolution
    from quasistatic_ref.step.contacts import Contacts
    from quasistatic_ref.step.data import Extra, StepData

CONTACT = ("contact", "gap [m]", "normal", "mu_v", "mu_omega [m]", "rows")
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
    names, active = cone(solution.cone).row_names, solution.certificate.active
    known = solution.certificate.kind == "exact"
    of_contact: dict[int, list[str]] = {}
    for j, i in active:
        of_contact.setdefault(j, []).append(names[i] if i < len(names) else str(i))
    return [
        (*map(number, wrench), " ".join(of_contact.get(j, ["none"])) if known else "not known")
        for j, wrench in enumerate(solution.wrench)
    ]


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
    return title, certificate_facts(certificate), ("contact", *FORCE), rows
