"""The exact answer of a step: the optimum, or a plain account of why there is none."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.certify.active_set import Farkas
from quasistatic_ref.certify.exact import ExactOptimum, exact_optimum
from quasistatic_ref.certify.farkas import farkas_vector
from quasistatic_ref.certify.norm import EnergyNorm, energy_norm
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.errors import InputError, StepIllPosed, StepInfeasible
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import load, standard_form
from quasistatic_ref.tolerances import ILL_POSED


def exact_step(step: StepData, warm: Sequence[int] = ()) -> ExactOptimum:
    """The exact optimum of Eq. :eq:`eq-13`.

    Parameters
    ----------
    step : StepData
        SI units.
    warm : sequence of int
        Rows that a solver found active; see :func:`~quasistatic_ref.certify.warm.warm_rows`.

    Returns
    -------
    ExactOptimum

    Raises
    ------
    InputError
        If the cone is no polyhedron.
    StepInfeasible
        If no displacement satisfies the rows, with the proof.
    StepIllPosed
        If the optimum is absurdly long.
    """
    if not cone(step.cone).polyhedral:
        raise InputError("has no rational optimum", field="cone", value=step.cone)
    form = exact_form(step)
    optimum = exact_optimum(form, warm)
    if isinstance(optimum, Farkas):
        raise StepInfeasible(step, farkas_vector(step, form, optimum))
    norm = energy_norm(step.H)
    return well_posed(step, optimum, norm, norm.impulse(load(step)))


def well_posed(
    step: StepData, optimum: ExactOptimum, norm: EnergyNorm, free: float
) -> ExactOptimum:
    """An optimum of a step, unless it is absurdly long.

    Parameters
    ----------
    step : StepData
    optimum : ExactOptimum
    norm : EnergyNorm
        That of the step.
    free : float
        ||H^-1 g||_H in it [(N m s)^0.5].

    Raises
    ------
    StepIllPosed
    """
    # Of three loads' steps the longest is at least a third of the step that they cause together.
    if norm.displacement(optimum.delta_q) <= ILL_POSED / 4 * free:
        return optimum
    check_length(step, optimum.delta_q, norm)
    return optimum


def check_length(step: StepData, delta_q: Array, norm: EnergyNorm | None = None) -> None:
    """Refuse a delta_q, shape (n_v,) [m, rad], that is absurdly long: StepIllPosed."""
    length = relative_length(step, delta_q, norm)
    if not length <= ILL_POSED:
        raise StepIllPosed(step, delta_q, length)


def relative_length(step: StepData, delta_q: Array, norm: EnergyNorm | None = None) -> float:
    """||delta_q||_H over the largest step that the loads or a single row ask for alone [-].

    That is the largest of four lengths in the H norm. Three are those of the unconstrained steps
    that the targets, tau_a and tau_u would each cause alone (together they may cancel, but for
    rounding). The fourth is max_i b_i / ||a_i||, in the norm of H^-1: the shortest step that
    satisfies the row i alone (a body pushed out of penetration moves however small g is). Without
    loads and penetration, zero is the optimum.

    Parameters
    ----------
    step : StepData
    delta_q : ndarray, shape (n_v,)
    norm : EnergyNorm, optional
        That of the step, where it is known.

    Returns
    -------
    float
    """
    form, h, n_a = standard_form(step), step.h, step.n_a
    norm = energy_norm(form.H) if norm is None else norm
    loads = np.zeros((3, step.n_v))
    loads[0, :n_a], loads[1, :n_a] = h * step.K_q @ step.delta_q_bar_a, h * step.tau_a
    loads[2, n_a:] = h * step.tau_u
    pushed = form.b > 0
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        push_out = form.b[pushed] / norm.impulses(form.A[pushed])
        wanted = float(max(norm.impulses(loads).max(), push_out.max(initial=0.0)))
        length = norm.displacement(delta_q)
        return length / wanted if wanted else (0.0 if length == 0 else float("inf"))
