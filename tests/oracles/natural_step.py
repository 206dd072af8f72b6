"""A step in natural units that is a step again, checked like any other."""

from dataclasses import replace

import numpy as np

from quasistatic_ref.solve.units import Units, natural_hessian, reach, units_of
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import Extra, StepData
from quasistatic_ref.step.standard_form import standard_form


def natural_units(step: StepData) -> Units:
    """Units in which the diagonal of H, the rows of A and the unconstrained step are about one.

    Parameters
    ----------
    step : StepData
        In SI units.

    Returns
    -------
    Units
        A function of the step alone, so that a step replayed by itself gives the same numbers.
    """
    form = standard_form(step)
    return units_of(form, natural_hessian(form.H))


def to_natural(step: StepData, units: Units) -> StepData:
    """The same step in natural units; h, n, d1, d2, mu_v and mu_omega stay as they are.

    Raises
    ------
    StepDataError
        If a number leaves the range of float64.
    """
    S, ell, rho = units.coordinate, units.length, units.size
    S_a, S_u = S[: step.n_a], S[step.n_a :]
    c, extra = step.contacts, step.extra
    phi, J = c.phi / (rho * ell), c.J * (S / ell)
    return step.replace(
        K_q=step.K_q * np.outer(S_a, S_a),
        M_u=step.M_u * np.outer(S_u, S_u),
        tau_a=step.tau_a * S_a / rho,
        tau_u=step.tau_u * S_u / rho,
        delta_q_bar_a=step.delta_q_bar_a / (rho * S_a),
        contacts=Contacts(c.name, phi, c.n, c.d1, c.d2, J, c.mu_v, c.mu_omega, c.rows),
        extra=Extra(extra.names, extra.A * (S / ell), extra.b / (rho * ell)),
    )


def within_reach(natural):
    """The same step with contacts that are too far to matter moved nearer."""
    nothing = Units(np.ones(natural.n_v), 1.0, 1.0)
    near = np.minimum(natural.contacts.phi, reach(natural, nothing))
    return natural.replace(contacts=replace(natural.contacts, phi=near))
