r"""Contact forces with one answer: those of the same step in which each contact gives way a little.

Optimal multipliers are not unique: four feet of a rigid block share its weight in many ways. With a
compliance c [m/N] at each contact there is one way; contacts of a group have one c
(:mod:`~quasistatic_ref.optional.forces.of_group`). A contact's gap, slips and spin after the
step are four lengths z = B delta_q + (phi, 0, 0, 0), which its friction cone confines to a cone K.
In the step with compliance a private displacement s of four lengths is added to z, and
\|s\|^2 / (2c) to the energy:

.. math:: z + s \in K, \qquad p = s / c = (f_n, f_1/\mu_v, f_2/\mu_v, \tau_n/\mu_\omega) \in F.

F is the cone of the forces: what multipliers >= 0 of the rows of K combine to. This is a step again
(:func:`compliant_form`), in which s is un-actuated and has the inertia h^2 / c. Without s, it is a
step without contact rows, in which each contact pushes with the point of F nearest to -z:

.. math:: c\,p_j = \Pi_F(-z_j), \qquad H \delta q - g = h \sum_j B_j^T p_j.

On a face of F the nearest point is linear in z. Once the face of each contact is known, delta_q
solves a linear system. The faces are guessed in float64. Exact signs decide whether they are right;
where they are not, Newton's method in exact numbers goes on from them. The forces of the exact
solution are rounded correctly.

Limit and noise (R42): compliance takes h c / 2 \|p\|^2 off the dual objective. It is then strictly
concave, and p_c tends to the optimal p of least norm (Tikhonov). If the gaps change by eps, then
c dp'(B dx + eps) <= -c^2 \|dp\|^2, because projections are firmly nonexpansive, and
\|dx\|_H^2 = h dp'B dx. Loss (R43): the conditions for 0 and for c give p'z = 0, p_c'z >= 0 and
p'(z_c + c p_c) >= 0, and so \|x_c - x\|_H^2 = h (p_c - p)'(z_c - z) <= h c p_c'(p - p_c).
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from flint import arb, arb_mat
from numpy.typing import ArrayLike

from quasistatic_ref.certify.curved_cone import Enclosed, curved_cone
from quasistatic_ref.certify.failures import StepInfeasible, StepNotSolved
from quasistatic_ref.certify.groups import group_steps
from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.certify.optimum import ExactOptimum, step_optimum
from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.errors import InputError
from quasistatic_ref.exact.active_set import dual_active_set
from quasistatic_ref.exact.minimiser import Minimiser
from quasistatic_ref.exact.program import EXACT, MatrixProgram, columns, exact_matrix
from quasistatic_ref.numbers.arrays import Array, checked_numbers, without_warnings
from quasistatic_ref.numbers.precision import working_precision
from quasistatic_ref.optional.forces.eliminated import eliminated_optimum
from quasistatic_ref.optional.forces.face_guess import guessed_faces
from quasistatic_ref.optional.forces.faces import cone_rows
from quasistatic_ref.optional.forces.of_group import NOTHING_MOVES, group_compliance
from quasistatic_ref.optional.friction import scaled_by
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData, check_step
from quasistatic_ref.step.friction import contact_wrenches
from quasistatic_ref.step.solution import ContactForces
from quasistatic_ref.step.standard_form import frame_jacobian

WRENCH: Final = [1, 2, 0, 3]
"""Where (f_d1, f_d2, f_n, tau_n) stand in p."""


def contact_forces(
    step: StepData,
    compliance: ArrayLike | None = None,
    near: tuple[Array, Array] | None = None,
) -> ContactForces:
    """The forces of a step's contacts, each number rounded correctly.

    In the ellipsoid, whose forces are in general not rational, they are rounded from an enclosure.

    Parameters
    ----------
    step : StepData
    compliance : float or ndarray, shape (n_c,), optional
        Of each contact [m/N], > 0, the same for all contacts of a group; by default
        :func:`~quasistatic_ref.optional.forces.of_group.group_compliance` of each group.
    near : (ndarray, ndarray), optional
        delta_q, shape (n_v,) [m, rad], and wrenches, shape (n_c, 4) [N, N m], of the step without
        compliance. Without them, that step is solved first. Forces do not depend on them.

    Returns
    -------
    ContactForces

    Raises
    ------
    InputError
        If a compliance is no positive number or differs within a group, or nothing can be proved in
        this thread.
    StepDataError
        If H, formed without rounding, is not positive definite.
    StepInfeasible, StepIllPosed
        If the step has no solution, and `near` does not say otherwise.
    StepNotSolved
        If in the ellipsoid no enclosure is found.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> qr.contact_forces(step).wrench.round(3)[0, 2]  # the weight [N]
    np.float64(2.943)
    """
    check_step(step)
    chosen = None
    if compliance is not None:
        numbers = checked_numbers(compliance, "compliance", InputError)
        if numbers.shape not in ((), (step.contacts.n_c,)):
            problem = "must be a number, or one for each contact"
            raise InputError(problem, field="compliance", value=compliance)
        chosen = np.broadcast_to(numbers, step.contacts.n_c)
    if chosen is not None and not (np.isfinite(chosen) & (chosen > 0)).all():
        problem = "must be a positive number of metres per newton"
        raise InputError(problem, field="compliance", value=compliance)
    x, wrench = _without_compliance(step) if near is None else _pair(step, near)
    forces = np.zeros((step.contacts.n_c, 4))
    delta_q = np.zeros(step.n_v)
    compliances = np.zeros(step.contacts.n_c)
    imbalance = sensitivity = 0.0
    for group, part in group_steps(step):
        members = group.contacts
        c = group_compliance(part) if chosen is None else _one_of(chosen[members])
        try:
            group_forces = _of_group(part, c, (x[group.coordinates], wrench[members]))
        except StepInfeasible:
            step_optimum(step)  # says so of the whole step
            raise
        forces[members] = group_forces.wrench
        delta_q[group.coordinates] = group_forces.delta_q
        compliances[members] = c
        imbalance = max(imbalance, group_forces.imbalance)
        sensitivity = max(sensitivity, group_forces.sensitivity)
    return ContactForces(forces, delta_q, compliances, imbalance, sensitivity)


def _pair(step: StepData, near: object) -> tuple[Array, Array]:
    """The arrays of `near`; InputError of anything else."""
    if not isinstance(near, list | tuple) or len(near) != 2:
        raise InputError("must be delta_q and wrenches", field="near", value=near)
    x, wrench = (checked_numbers(one, "near", InputError) for one in near)
    if x.shape != (step.n_v,) or wrench.shape != (step.contacts.n_c, 4):
        problem = f"must have shapes ({step.n_v},) and ({step.contacts.n_c}, 4)"
        raise InputError(problem, field="near", value=[x.shape, wrench.shape])
    return x, wrench


def _one_of(compliances: Array) -> float:
    """The one compliance [m/N] that all contacts of a group, shape (c,), are given."""
    distinct = np.unique(compliances)
    if len(distinct) > 1:
        problem = "must be one number for all contacts of a group"
        raise InputError(problem, field="compliance", value=distinct.tolist())
    return float(distinct[0]) if len(distinct) else NOTHING_MOVES


def _without_compliance(step: StepData) -> tuple[Array, Array]:
    """delta_q, shape (n_v,), and wrenches, shape (n_c, 4) [N, N m], of the step itself."""
    optimum: Enclosed | ExactOptimum | None
    if not cone(step.cone).polyhedral:
        optimum = curved_cone(step).optimum(step, None)
        if optimum is None:
            raise StepNotSolved("none", "no enclosure of the optimum was found", step, 0.0)
    else:
        optimum = step_optimum(step)
    multipliers = optimum.lam[: step.offsets[-1]]
    return optimum.delta_q, contact_wrenches(step.contacts, multipliers, step.h, step.cone)


def _of_group(step: StepData, c: float, near: tuple[Array, Array]) -> ContactForces:
    """The forces of a step by itself, or of a group of one, by one compliance [m/N]."""
    if not cone(step.cone).polyhedral:
        wrench, delta_q = curved_cone(step).forces(step, c, near)
    else:
        faces = without_warnings(guessed_faces, step, c, near[1])
        p, delta_q = eliminated_optimum(step, c, faces) or defined_optimum(step, c)
        wrench = p[:, WRENCH]
    n_c = step.contacts.n_c
    load = float(wrench[:, 2].sum())
    gap = c * load  # that this load closes by compliance [m]; a subnormal load may leave zero
    return ContactForces(
        wrench,
        delta_q,
        compliance=np.full(n_c, c),
        imbalance=_left(step, wrench, near[0] - delta_q),
        sensitivity=float(np.sqrt(n_c)) / gap if gap else (math.inf if load else 0.0),
    )


def _left(step: StepData, wrench: Array, off: Array) -> float:
    """The share of the load that forces, (n_c, 4), leave if displacements differ by (n_v,) [-]."""
    if not (off.any() and wrench.any()):
        return 0.0
    J_n, J_1, J_2, J_w = frame_jacobian(step.contacts, step.contacts.J)
    exerted = np.einsum("kj,kji->i", wrench.T, np.array([J_1, J_2, J_n, J_w]))
    norm = energy_norm(step.H)
    load = norm.of_impulse(step.h * exerted)
    return norm.of_displacement(off) / load if load else float("inf")


def compliant_form(step: StepData, compliance: float) -> MatrixProgram:
    """The step with compliance: its coordinates are [delta_q; s], s of four lengths a contact [m].

    Parameters
    ----------
    step : StepData
        In a polyhedral cone.
    compliance : float
        [m/N].

    Returns
    -------
    MatrixProgram
        Rows as of :class:`~quasistatic_ref.exact.program.StepProgram`; multipliers are h c lam.
    """
    form = StepProgram(step)
    n = step.n_v
    lengths = 4 * step.contacts.n_c
    gives = np.zeros((step.m, lengths))
    gives[: step.offsets[-1]] = cone_rows(step)
    every = zip(form.exact_rows(range(step.m)), exact_matrix(gives).tolist(), strict=True)
    rows = [[*row[:n], *of_s, row[n]] for row, of_s in every]
    with working_precision(EXACT):  # Eq. (13) with the energy |s|^2 / (2c), times h c
        H = exact_matrix(np.eye(n + lengths)) * (form.h * form.h)
        for i, row in enumerate((form.H * arb(compliance)).tolist()):
            for j, v in enumerate(row):
                H[i, j] = v
        g = [v * compliance for v in form.g.entries()] + [arb(0)] * lengths
    size = n + lengths + 1
    return MatrixProgram(H, arb_mat(size - 1, 1, g), columns(rows, slice(0, size)))


def defined_optimum(step: StepData, compliance: float) -> tuple[Array, Array]:
    """The optimum of the step with compliance, computed directly from its definition.

    It equals that of :func:`~quasistatic_ref.optional.forces.eliminated.eliminated_optimum`.
    Every s is solved for, which takes 30 times longer, and always ends.

    Parameters
    ----------
    step : StepData
        In a polyhedral cone; the user's own rows do not contradict each other.
    compliance : float
        [m/N].

    Returns
    -------
    ndarray, shape (n_c, 4)
        (f_n, f_d1, f_d2, tau_n) of each contact [N, N m].
    ndarray, shape (n_v,)
        delta_q.
    """
    end = dual_active_set(compliant_form(step, compliance))
    assert isinstance(end, Minimiser)
    mu = [arb(v) for v in scaled_by(step.contacts).ravel().tolist()]
    n = step.n_v
    p = end.rounded(
        lambda optimum: [m * s for m, s in zip(mu, optimum.x[n:], strict=True)], arb(compliance)
    )
    return p.reshape(-1, 4), end.rounded(lambda optimum: optimum.x[:n])
