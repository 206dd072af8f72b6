"""How H, g, A and b change with the parameters of a step, exactly.

They are those of Eqs. :eq:`eq-1`, :eq:`eq-4`-:eq:`eq-8`, :eq:`eq-13`.

Each derivative is a rational number in SI units; A and b are affine in every parameter.
"""

from dataclasses import dataclass, field

import numpy as np
from flint import fmpq

from quasistatic_ref.certify.rational import Dyadic, contact_motion, fraction, two_to
from quasistatic_ref.step.cones import cone_function, cone_matrix
from quasistatic_ref.step.data import StepData

Vector = list[fmpq]


@dataclass(frozen=True, eq=False)
class Change:
    """Derivatives by one parameter; what is not named does not change.

    Parameters
    ----------
    group : str
        ``"phi"``.
    name : str
        ``"phi[left/17]"``.
    H : dict of (int, int) to fmpq
    g : list of fmpq
        All of dg, or empty.
    A : dict of int to list of fmpq
        By row.
    b : dict of int to fmpq
        By row.
    at_zero : bool
        Whether it is a friction coefficient that is used, and zero.
    """

    group: str
    name: str
    H: dict[tuple[int, int], fmpq] = field(default_factory=dict)
    g: Vector = field(default_factory=list)
    A: dict[int, Vector] = field(default_factory=dict)
    b: dict[int, fmpq] = field(default_factory=dict)
    at_zero: bool = False


def parameter_changes(step: StepData) -> list[Change]:
    """Changes by every parameter that a derivative is given for."""
    return [*_loads(step), *_gaps(step), *_coefficients(step), _time_step(step)]


def _loads(step: StepData) -> list[Change]:
    n_a = step.n_a
    n_v = step.n_v
    h = fraction(step.h)
    K = [[fraction(v) for v in row] for row in step.K_q.tolist()]
    rest = [fmpq(0)] * step.n_u
    targets = [
        Change("delta_q_bar_a", f"delta_q_bar_a[{k}]", g=[h * K[i][k] for i in range(n_a)] + rest)
        for k in range(n_a)
    ]
    forces = [
        Change("tau_a", f"tau_a[{k}]", g=_unit(k, n_v, h))
        if k < n_a
        else Change("tau_u", f"tau_u[{k - n_a}]", g=_unit(k, n_v, h))
        for k in range(n_v)
    ]
    stiffness = [
        Change("K_q", f"K_q[{k}, {k}]", H={(k, k): h}, g=_unit(k, n_v, h * fraction(target)))
        for k, target in enumerate(step.delta_q_bar_a.tolist())
    ]
    return targets + forces + stiffness


def _gaps(step: StepData) -> list[Change]:
    ends = step.offsets.tolist()
    return [
        Change("phi", f"phi[{name}]", b=dict.fromkeys(range(ends[j], ends[j + 1]), fmpq(-1)))
        for j, name in enumerate(step.contacts.name)
    ]


def _coefficients(step: StepData) -> list[Change]:
    """A is linear in mu_v and mu_omega: the cone of what one of them multiplies is its change."""
    J_n, J_1, J_2, J_w = (contact_motion(step.contacts)[:, i] for i in range(4))
    none = J_n - J_n
    rows = cone_function(step.cone)
    coefficients = cone_matrix(step.cone)
    slides = coefficients[:, 1:3].any(axis=1)
    spins = coefficients[:, 3] != 0
    mu_v, _, mu_omega = step.contacts.mu.T
    torsional = step.contacts.rows == 6
    changes = []
    for symbol, mu, by, changed in (
        ("mu_v", mu_v, rows(none, J_1, J_2, none), step.mask & slides),
        ("mu_omega", mu_omega, rows(none, none, none, J_w), step.mask & torsional[:, None] & spins),
    ):
        for j, name in enumerate(step.contacts.name):
            A = {int(step.offsets[j] + i): _vector(by[i][j]) for i in np.flatnonzero(changed[j])}
            at_zero = bool(A) and mu[j] == 0
            changes.append(Change(symbol, f"{symbol}[{name}]", A=A, at_zero=bool(at_zero)))
    return changes


def _time_step(step: StepData) -> Change:
    n_a = step.n_a
    h = fraction(step.h)
    K = [[fraction(v) for v in row] for row in step.K_q.tolist()]
    M = [[fraction(v) for v in row] for row in step.M_u.tolist()]
    target = [fraction(v) for v in step.delta_q_bar_a.tolist()]
    H = {(i, j): v for i, row in enumerate(K) for j, v in enumerate(row)}
    H |= {(n_a + i, n_a + j): -v / h**2 for i, row in enumerate(M) for j, v in enumerate(row)}
    pull = [sum((v * t for v, t in zip(row, target, strict=True)), fmpq(0)) for row in K]
    forces = [fraction(v) for v in (*step.tau_a.tolist(), *step.tau_u.tolist())]
    g = [f + (pull[i] if i < n_a else 0) for i, f in enumerate(forces)]
    return Change("h", "h", H=H, g=g)


def _vector(exact: Dyadic) -> Vector:
    return [two_to(exact.e) * m for m in exact.m.tolist()]


def _unit(k: int, n: int, value: fmpq) -> Vector:
    return [value if i == k else fmpq(0) for i in range(n)]
