r"""Natural units: the same problem in numbers near one.

Absolute tolerances of solvers mean nothing for a body of 0.1 kg that moves by 1e-6 m. With

.. math:: \delta q = \rho\,S\,x,\qquad \text{lengths in units of } \rho\,\ell

Eqs. :eq:`eq-13` and :eq:`eq-4` keep their form: S is diagonal, one unit per coordinate, such that
the diagonal of H becomes about one; ell is one length, such that the rows become about one; and
rho is the size of the step. The matrices do not depend on rho, because the problem is positively
homogeneous in (g, phi). All units are powers of two, so the conversion loses nothing (short of
underflow).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.step.data import Array, Extra, StepData
from quasistatic_ref.step.standard_form import standard_form
from quasistatic_ref.tolerances import FAR

STANDSTILL = 2.0**-100
"""Size of a step that nothing drives [-]."""


@dataclass(frozen=True, eq=False)
class Units:
    """Units of one step.

    Parameters
    ----------
    coordinate : ndarray, shape (n_v,)
        Diagonal of S [m, rad].
    length : float
        ell [m].
    size : float
        rho [-].
    """

    coordinate: Array
    length: float
    size: float


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
    coordinate = _power_of_two(1 / np.sqrt(np.diag(form.H)))
    row_norms = np.linalg.norm(form.A * coordinate, axis=1)
    length = _power_of_two(_typical(row_norms))
    unconstrained = np.linalg.solve(form.H, form.g)
    energy = float(np.sqrt(form.g @ unconstrained))  # ||H^-1 g||_H
    push_out = float(form.b.max(initial=0.0)) / float(length)  # from penetration
    gap = float(np.abs(form.b).max(initial=0.0)) / float(length)
    # Where nothing pushes and nothing is far, the answer is zero: the smaller the unit, the nearer.
    size = max(energy, push_out) or gap or STANDSTILL
    return Units(coordinate, float(length), float(_power_of_two(size)))


def to_natural(step: StepData, units: Units) -> StepData:
    """The same step in natural units; h, n, d1, d2, mu_v and mu_omega stay as they are."""
    S, ell, rho = units.coordinate, units.length, units.size
    S_a, S_u = S[: step.n_a], S[step.n_a :]
    contacts = replace(
        step.contacts, phi=step.contacts.phi / (rho * ell), J=step.contacts.J * (S / ell)
    )
    extra = Extra(step.extra.names, step.extra.A * (S / ell), step.extra.b / (rho * ell))
    return step.replace(
        K_q=step.K_q * np.outer(S_a, S_a),
        M_u=step.M_u * np.outer(S_u, S_u),
        tau_a=step.tau_a * S_a / rho,
        tau_u=step.tau_u * S_u / rho,
        delta_q_bar_a=step.delta_q_bar_a / (rho * S_a),
        contacts=contacts,
        extra=extra,
    )


def within_reach(natural: StepData) -> StepData:
    """The same step with contacts that are too far to matter moved nearer, for solvers' sake."""
    far = out_of_reach(natural)
    if not far.any():
        return natural
    near = np.where(far, _reach(natural), natural.contacts.phi)
    return natural.replace(contacts=replace(natural.contacts, phi=near))


def out_of_reach(natural: StepData) -> NDArray[np.bool_]:
    """Which contacts are too far to matter, shape (n_c,)."""
    return np.asarray(natural.contacts.phi > _reach(natural))


def _reach(natural: StepData) -> Array:
    return np.asarray(FAR * np.maximum(1.0, np.linalg.norm(natural.contacts.J, axis=(1, 2))))


def from_natural(delta_q: Array, lam: Array, units: Units) -> tuple[Array, Array]:
    """delta_q (n_v,) [m, rad] and lam (m,) [N s] from their values in natural units."""
    S, ell, rho = units.coordinate, units.length, units.size
    return delta_q * (rho * S), lam * (rho / ell)


def _typical(norms: Array) -> float:
    positive = norms[norms > 0]
    return float(np.median(positive)) if positive.size else 1.0


def _power_of_two(x: Array | float) -> Array:
    return np.exp2(np.round(np.log2(x)))
