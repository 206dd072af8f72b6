"""A step and its certificate in words: what ``repr`` and a notebook show of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from quasistatic_ref.optional.show.show import Page, direction, number
from quasistatic_ref.quoting import counted

if TYPE_CHECKING:
    from quasistatic_ref.step.data import StepData
    from quasistatic_ref.step.solution import Certificate

CONTACT = ("contact", "gap [m]", "normal", "mu_v", "mu_omega [m]", "rows")


def certificate_page(certificate: Certificate) -> Page:
    """A certificate in words: what it proves of a solution."""
    residual = max(certificate.residuals.values(), default=None)
    facts = [f"worst residual {number(residual)}, error bound {number(certificate.error_bound)}"]
    known = certificate.multipliers_unique, certificate.differentiable
    if None not in known:
        unique, smooth = ("" if one else "not " for one in known)
        facts.append(
            f"{counted(len(certificate.active), 'active row')}; multipliers "
            f"{unique}unique, delta_q {smooth}differentiable"
        )
    return f"Certificate: {certificate.kind}", facts, (), ()


def step_page(step: StepData) -> Page:
    """A step: what moves, and its contacts, the nearest first, which may bear load."""
    title = (
        f"StepData: h = {step.h:g} s, {counted(step.n_v, 'coordinate')} ({step.n_a} actuated), "
        f"{counted(step.contacts.n_c, 'contact')}, {counted(int(step.offsets[-1]), 'row')}, "
        f"cone {step.cone}"
    )
    facts = [f"{counted(len(step.extra.names), 'further row')}"] if step.extra.names else []
    facts += ["a user's quadratic cost in H and g"] if step.extra.cost is not None else []
    contacts = step.contacts
    friction = zip(contacts.mu_v, contacts.mu_omega, contacts.rows, strict=True)
    rows = [
        (name, number(phi), direction(n), number(mu_v), number(mu_omega), str(m))
        for name, phi, n, (mu_v, mu_omega, m) in zip(
            contacts.name, contacts.phi, contacts.n, friction, strict=True
        )
    ]
    return title, facts, CONTACT, [rows[j] for j in contacts.phi.argsort(kind="stable")]
