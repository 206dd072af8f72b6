"""How the data of a step change with its parameters, exactly.

They are those of Eqs. :eq:`eq-1`, :eq:`eq-4`-:eq:`eq-8`, :eq:`eq-13`.

Each derivative is a rational number in SI units; A and b are affine in every parameter.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np
from flint import fmpq

from quasistatic_ref.certify.rational import Integers, contact_motion, fraction, two_to
from quasistatic_ref.optional.derivatives.step.load_rates import load_rates
from quasistatic_ref.step.cones import cone_function, cone_matrix
from quasistatic_ref.step.data import StepData

Fractions = Integers
"""Arrays of fmpq."""


@dataclass(frozen=True, eq=False)
class Change:
    """Derivatives by one parameter.

    Parameters
    ----------
    group : str
        ``"phi"``.
    name : str
        ``"phi[left/17]"``.
    load : ndarray of fmpq, shape (n_v,)
        Of g - H x, x being fixed [N s per unit].
    rows : mapping of int to ndarray of fmpq, shape (n_v + 1,)
        Of [a, b] of each row of A x >= b that changes.
    at_zero : bool
        Whether it is a friction coefficient that is used, and zero.
    """

    group: str
    name: str
    load: Fractions
    rows: Mapping[int, Fractions] = field(default_factory=dict)
    at_zero: bool = False

    def gap_rate(self, i: int, x: Fractions) -> fmpq:
        """Derivative of b_i - a_i x, x of shape (n_v,) being fixed [m per unit]."""
        return self.rows[i] @ [*-x, fmpq(1)] if i in self.rows else fmpq(0)


def parameter_changes(step: StepData, x: Fractions) -> list[Change]:
    """Changes by every parameter that a derivative is given for.

    Parameters
    ----------
    step : StepData
    x : ndarray of fmpq, shape (n_v,)
        Its displacement [m, rad].
    """
    unloaded = 0 * x
    return [*_loads(step, x), *_gaps(step, unloaded), *_coefficients(step, unloaded)]


def _loads(step: StepData, x: Fractions) -> Iterator[Change]:
    exact = np.vectorize(fraction, otypes=[object])
    tau = exact(np.concatenate([step.tau_a, step.tau_u]))
    matrices = exact(step.K_q), exact(step.M_u)
    rates = load_rates(fraction(step.h), *matrices, tau, exact(step.delta_q_bar_a), x)
    yield Change("h", "h", rates["h"][:, 0])
    for group, columns in (
        ("delta_q_bar_a", rates["delta_q_bar_a"]),
        ("tau_a", rates["tau"][:, : step.n_a]),
        ("tau_u", rates["tau"][:, step.n_a :]),
    ):
        for k, load in enumerate(columns.T):
            yield Change(group, f"{group}[{k}]", load)
    for k, load in enumerate(rates["K_q"].T):
        yield Change("K_q", f"K_q[{k}, {k}]", load)


def _gaps(step: StepData, unloaded: Fractions) -> Iterator[Change]:
    ends = step.offsets.tolist()
    raised = np.array([*unloaded, fmpq(-1)])  # b is -phi
    for j, name in enumerate(step.contacts.name):
        rows = dict.fromkeys(range(ends[j], ends[j + 1]), raised)
        yield Change("phi", f"phi[{name}]", unloaded, rows)


def _coefficients(step: StepData, unloaded: Fractions) -> Iterator[Change]:
    """A is linear in mu_v and mu_omega: the cone of what one of them multiplies is its change."""
    contacts = step.contacts
    J_n, J_1, J_2, J_w = (contact_motion(contacts)[:, i] for i in range(4))
    none = J_n - J_n
    rows = cone_function(step.cone)
    coefficients = cone_matrix(step.cone)
    slides = coefficients[:, 1:3].any(axis=1)
    spins = (coefficients[:, 3] != 0) & contacts.torsion[:, None]
    for symbol, mu, by, changes in (
        ("mu_v", contacts.mu_v, rows(none, J_1, J_2, none), step.mask & slides),
        ("mu_omega", contacts.mu_omega, rows(none, none, none, J_w), step.mask & spins),
    ):
        for j, name in enumerate(contacts.name):
            own = {
                int(step.offsets[j] + i): np.array([*(two_to(by[i].e) * by[i].m[j]), fmpq(0)])
                for i in np.flatnonzero(changes[j])
            }
            at_zero = bool(own) and bool(mu[j] == 0)
            yield Change(symbol, f"{symbol}[{name}]", unloaded, own, at_zero)
