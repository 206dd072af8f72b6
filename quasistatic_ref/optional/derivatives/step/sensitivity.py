r"""Derivatives of the exact optimum, and where there are none.

Let S be the strictly active rows, those positive in *some* optimal multiplier. While they stay
without slack and the others do not lose theirs, delta_q is the minimiser on A_S x = b_S, and

.. math:: H\,dx - A_W^T d\lambda = dg - dH\,x + dA_W^T \lambda, \qquad
          A_W\,dx = db_W - dA_W\,x

for independent rows W that span S. Whether they stay is decided for each parameter by itself:

- The equations of S must stay consistent. They do iff the rank of [A_S b_S] does not grow with the
  parameter; it grows everywhere else or nowhere, so one other value decides. (All six rows of a
  sticking contact change together and keep their rank of four; the gap of one of two equal contacts
  breaks it.)
- A row without slack that is not strictly active must keep its slack of zero: otherwise it would
  hold on one side and let go on the other. Its equation then stays consistent with those of S.
- A friction coefficient that is zero cannot become smaller.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from flint import fmpq_mat, fmpz_mat

from quasistatic_ref.certify.certificate import Certificate
from quasistatic_ref.certify.dependence import combination, independent_rows, tight_rows
from quasistatic_ref.certify.minimiser import rational_solution
from quasistatic_ref.certify.rational import ExactForm, exact_form
from quasistatic_ref.certify.rounding import nearest_fraction
from quasistatic_ref.certify.rows import flat_rows, row_owners
from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.quoting import listed
from quasistatic_ref.formats.shown import Shown
from quasistatic_ref.optional.derivatives.step.parameters import (
    Change,
    Fractions,
    parameter_changes,
)
from quasistatic_ref.optional.derivatives.step.strictly_active import strictly_active
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, StepData

FIELDS = ("delta_q_bar_a", "tau_a", "K_q", "tau_u", "phi", "mu_v", "mu_omega", "h")


@dataclass(frozen=True, eq=False, repr=False)
class Sensitivity(Shown):
    """d delta_q by each parameter of a step, correctly rounded; NaN where there is none.

    Parameters
    ----------
    delta_q_bar_a, tau_a, K_q : ndarray, shape (n_v, n_a)
        K_q: by its diagonal.
    tau_u : ndarray, shape (n_v, n_u)
    phi, mu_v, mu_omega : ndarray, shape (n_v, n_c)
    h : ndarray, shape (n_v, 1)
    why_not : mapping of str to str
        For each parameter without a derivative, e.g. ``"phi[left/17]"``, a sentence that names the
        contacts.
    """

    delta_q_bar_a: Array
    tau_a: Array
    K_q: Array
    tau_u: Array
    phi: Array
    mu_v: Array
    mu_omega: Array
    h: Array
    why_not: Mapping[str, str]


@dataclass(frozen=True, eq=False)
class Active:
    """The rows without slack at an optimum, sorted.

    Parameters
    ----------
    basis : tuple of int
        Independent rows that span the strictly active ones.
    strict, idle : tuple of int
        Those positive in some optimal multiplier, and the others.
    """

    basis: tuple[int, ...]
    strict: tuple[int, ...]
    idle: tuple[int, ...]


def sensitivity(step: StepData, certificate: Certificate) -> Sensitivity:
    """Derivatives of the optimum of a step in a polyhedral cone.

    Parameters
    ----------
    step : StepData
        SI units.
    certificate : Certificate
        Of this step and of kind ``"exact"``; its working set is what is believed of it.

    Returns
    -------
    Sensitivity

    Raises
    ------
    InputError
        If the certificate is of another step or kind, or the cone no polyhedron.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> qr.sensitivity(step, qr.solve_step(step).certificate).tau_u.shape
    (6, 6)
    """
    if certificate.kind != "exact" or not cone(step.cone).polyhedral:
        raise InputError(
            "needs an exact certificate in a polyhedral cone; solve with certify = 'full'",
            field="certificate",
            value=f"{certificate.kind}, {step.cone}",
        )
    if not certificate.is_of(step):
        problem = "is of another step; take that of the step's own solution"
        raise InputError(problem, field="certificate", value=certificate.step_sha256)
    form = exact_form(step)
    active = _active(form, flat_rows(step, certificate.active))
    solution = rational_solution(form, active.basis)
    x, lam = (
        unit / solution.denominator * np.array(numerators, dtype=object)
        for unit, numerators in ((form.x_unit, solution.x), (form.lam_unit, solution.lam))
    )
    changes = parameter_changes(step, x)
    columns = _rates(form, active.basis, x, lam, changes).T
    why_not: dict[str, str] = {}
    found: dict[str, list[Array]] = {name: [] for name in FIELDS}
    for change, dx in zip(changes, columns, strict=True):
        reason = _obstacle(step, form, active, change, x, dx)
        if reason:
            why_not[change.name] = reason
        values = [np.nan if reason else nearest_fraction(v) for v in dx]
        found[change.group].append(np.array(values))
    shaped = {name: np.array(own).reshape(-1, form.n).T for name, own in found.items()}
    return Sensitivity(**shaped, why_not=why_not)


def _active(form: ExactForm, working: tuple[int, ...]) -> Active:
    spanned, unspanned = tight_rows(form, working, rational_solution(form, working).slack)
    also = strictly_active(form, working, unspanned)
    strict = (*working, *spanned, *also)
    idle = tuple(i for i in unspanned if i not in also)
    return Active(independent_rows(form, strict), strict, idle)


def _rates(
    form: ExactForm,
    basis: tuple[int, ...],
    x: Fractions,
    lam: Fractions,
    changes: Sequence[Change],
) -> Fractions:
    """Return dx for every change, shape (n_v, P), in SI units."""
    n = form.n
    A = np.array(form.rows(basis), dtype=object).reshape(-1, n)
    free = np.zeros((len(basis), len(basis)), dtype=object)
    matrix = np.block([[np.array(form.H.tolist(), dtype=object), -A.T], [A, free]])
    right = []
    for change in changes:
        pulled = [
            m * change.rows[i][:n] for i, m in zip(basis, lam, strict=True) if i in change.rows
        ]
        gaps = [change.gap_rate(i, x) / form.slack_unit for i in basis]
        right.append([*(sum(pulled, change.load) / form.net_unit), *gaps])
    solution = fmpq_mat(fmpz_mat(matrix.tolist())).solve(fmpq_mat(right).transpose())
    return np.asarray(form.x_unit * np.array(solution.tolist(), dtype=object)[:n])


def _obstacle(
    step: StepData, form: ExactForm, active: Active, change: Change, x: Fractions, dx: Fractions
) -> str:
    """Return why there is no derivative, or nothing."""
    touched = [i for i in (*active.strict, *active.idle) if i in change.rows]
    if change.at_zero and touched:
        return f"it is zero, cannot be smaller, and {_names(step, touched)} touches"
    if any(i in active.strict for i in touched):
        tied = _inconsistent(form, active.strict, change)
        if tied:
            return f"the equations of {_names(step, tied)} would contradict each other"
    opening = [i for i in active.idle if _equation(form, i)[:-1] @ dx != change.gap_rate(i, x)]
    if opening:
        return f"{_names(step, opening)} touches without load: it holds on one side only"
    return ""


def _equation(form: ExactForm, i: int) -> Fractions:
    """Return [a, b] of a row in SI units."""
    a = np.array(form.row(i), dtype=object) / form.x_unit
    return np.asarray(form.slack_unit * np.array([*a, form.b[i, 0]]))


def _inconsistent(form: ExactForm, rows: Sequence[int], change: Change) -> list[int]:
    """Return rows whose equations would contradict each other; empty if all stay consistent."""
    moving = [i for i in rows if i in change.rows]
    still = independent_rows(form, [i for i in rows if i not in moving])
    basis = independent_rows(form, (*still, *moving))
    held = [_equation(form, i) for i in still]
    changed = [_equation(form, i) + change.rows[i] for i in moving]  # by one unit of the parameter
    if fmpq_mat([equation.tolist() for equation in held + changed]).rref()[1] <= len(basis):
        return []
    tied = set(moving)
    for i in moving:
        c = None if i in basis else combination(form, basis, i)
        tied |= {j for j, c_j in zip(basis, c or (), strict=False) if c_j}
    return sorted(tied)


def _names(step: StepData, rows: Sequence[int]) -> str:
    return listed(list(row_owners(step, rows)))
