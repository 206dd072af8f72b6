r"""The norm that errors and lengths are measured in, and the one definition of error.

.. math:: \mathrm{error} = \frac{\|x - x^*\|_H}{\ell}, \qquad
          \mathrm{digits} = -\log_{10} \mathrm{error} \text{, clipped to } 0 \ldots 16,

with ||v||_H^2 = v'Hv and the length ell of :func:`error_length`. Net impulses and slacks are
measured as the displacements that they stand for, so that the three can be compared:

- net impulse p = A'lam by the displacement H^-1 p that it causes:
  ||p - p*||_{H^-1} / ell, with ||p||_{H^-1} = ||H^-1 p||_H;
- slack of row i by the shortest displacement that changes it so much:
  max_i |a_i'(x - x*)| / ||a_i||_{H^-1} / ell, never more than the error of x.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np

from quasistatic_ref.certify.failures import StepIllPosed
from quasistatic_ref.certify.groups import Group, group_steps
from quasistatic_ref.errors import StepDataError
from quasistatic_ref.exact.digits import digits_of_error
from quasistatic_ref.numbers.arrays import Array, read_only
from quasistatic_ref.numbers.pivots import exact_factor
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.hessian import Hessian
from quasistatic_ref.step.standard_form import linear_term, spring_load, standard_form
from quasistatic_ref.tolerances import UNMOVED

Parts = Sequence[tuple[Group, StepData]]
"""The groups of a step, each as a step."""


ILL_POSED: Final = 1e6
"""Longest certified step: its length in the H norm over the largest of four lengths [-]. Three are
the lengths of the unconstrained steps that the targets, tau_a and tau_u would each cause alone; the
fourth is that of the longest push-out b_i / ||a_i|| of a single row, in the norm of H^-1.

Nearly contradictory contacts have exact optima of 1e13 m; steps of grasps stay below 1e2."""
MIDDLE = 1e-100, 1e100
"""Lengths that no overflow and no underflow on the way to them has changed."""


@dataclass(frozen=True, eq=False)
class EnergyNorm:
    """Lengths of displacements and of impulses, safe against overflow and underflow.

    Parameters
    ----------
    unit : ndarray, shape (n_v,)
        Units [m, rad] in which the diagonal of H is one: the factor stays regular at mass ratios
        of 1e9.
    L, inverse : ndarray, shape (n_v, n_v)
        Lower Cholesky factor of H in these units, and the inverse of that [-].
    """

    unit: Array
    L: Array
    inverse: Array

    def of_displacement(self, v: Array) -> float:
        """||v||_H of a displacement v, shape (n_v,) [m, rad]; its square is in [N m s]."""
        return math.hypot(*self.L.T.dot(v / self.unit).tolist())

    def of_impulse(self, p: Array) -> float:
        """||H^-1 p||_H of an impulse p, shape (n_v,) [N s, N m s]."""
        return math.hypot(*self.inverse.dot(p * self.unit).tolist())

    def of_impulses(self, P: Array) -> Array:
        """||H^-1 p||_H of each row p of P, shape (rows, n_v): how far an impulse moves; (rows,)."""
        lengths: Array = np.hypot.reduce(self.inverse @ (P * self.unit).T, axis=0)
        return lengths


def norm_of(step: StepData) -> EnergyNorm:
    """The norm of a step; errors as of :func:`energy_norm`."""
    if step.extra.cost is None:
        return norm_of_hessian(step.hessian)
    return energy_norm(step.H)


def norm_of_hessian(hessian: Hessian) -> EnergyNorm:
    """The norm of steps with this H; errors as of :func:`energy_norm`."""
    return hessian.once(_norm)


def _norm(hessian: Hessian) -> EnergyNorm:
    return energy_norm(hessian.matrix)


def energy_norm(H: Array) -> EnergyNorm:
    """The norm of a float64 H, shape (n_v, n_v) [N m s/m^2].

    Raises
    ------
    StepDataError
        If H, whose entries are rounded, is not positive definite, as that of a step may be if
        K_q or M_u is nearly singular.
    """
    return _energy_norm(H.tobytes(), len(H))


@lru_cache(maxsize=64)
def _energy_norm(entries: bytes, n: int) -> EnergyNorm:
    """The energy norm of H, cached, because most steps of a run have the same H."""
    H = np.frombuffer(entries).reshape(n, n)
    unit = 1 / np.sqrt(np.diag(H))
    try:
        L = np.linalg.cholesky(H * np.outer(unit, unit)).astype(np.float64)
    except np.linalg.LinAlgError:
        exact = exact_factor(H, 0.0)
        if exact is None:
            problem = (
                "must be positive definite in float64, too; look for a link of almost no mass or a "
                "spring of almost no stiffness"
            )
            raise StepDataError(problem, field="H", value=H.tolist()) from None
        L = exact * unit[:, None]
    inverse = np.linalg.inv(L).astype(np.float64)
    return EnergyNorm(read_only(unit), read_only(L), read_only(inverse))


def single_loads(step: StepData, scale: float = 1.0) -> Array:
    """Impulses of the targets, of tau_a and of tau_u, each by itself, shape (3, n_v) [N s, N m s].

    The g of a user's cost is a fourth. Their sum is g of the step. With a `scale` [-] the loads are
    multiplied by it first.
    """
    n_a = step.n_a
    loads = np.zeros((3, step.n_v))
    loads[0, :n_a] = step.h * spring_load(step.K_q, scale * step.delta_q_bar_a)
    loads[1, :n_a] = step.h * (scale * step.tau_a)
    loads[2, n_a:] = step.h * (scale * step.tau_u)
    cost = step.extra.cost
    return loads if cost is None else np.vstack([loads, scale * cost[1]])


def error_length(H: Array, g: Array, optimum: Array, loads: Iterable[Array] = ()) -> float:
    """The length ell that errors are divided by, in the norm of H [(N m s)^0.5]; or NaN.

    It is the largest of

    - ||H^-1 g||_H, the unconstrained step;
    - ||x*||_H, the optimum: a body that is pushed out of penetration moves without a load;
    - the unconstrained steps that the targets, tau_a, tau_u and a user's cost would each cause
      alone: at rest they cancel but for rounding, and g and x* are noise;
    - 1e-6 m or rad in the softest coordinate: where nothing happens at all, all others are zero.

    No row's b enters, but through x*: with it, a limit that is far away would hide wrong answers.

    Parameters
    ----------
    H : ndarray, shape (n_v, n_v)
        [N m s/m^2].
    g : ndarray, shape (n_v,)
    optimum : ndarray, shape (n_v,)
        x* [m, rad].
    loads : iterable of ndarray, shape (n_v,)
        The step's :func:`single_loads` [N s, N m s], where they are known.
    """
    norm = energy_norm(H)
    moved_by = map(norm.of_impulse, (g, *loads))
    return _length(norm.of_displacement(optimum), moved_by, H.diagonal().min())


def _length(moved: float, moved_by: Iterable[float], softest: float) -> float:
    """The length that errors are divided by: the largest of the optimum's and of single loads'."""
    length = max(moved, *moved_by, UNMOVED * math.sqrt(softest))
    return length if length < math.inf else math.nan


def single_lengths(parts: Parts) -> list[list[float]]:
    """Lengths of the unconstrained steps of groups: under each of :func:`single_loads`, then all.

    Parameters
    ----------
    parts : sequence of (Group, StepData)
        The groups of a step.

    Returns
    -------
    list of list of float
        Of each group [(N m s)^0.5].
    """
    return [
        [*map(norm_of(part).of_impulse, (*single_loads(part), linear_term(part)))]
        for _, part in parts
    ]


def over_groups(lengths: Sequence[Sequence[float]]) -> list[float]:
    """Lengths of a whole step [(N m s)^0.5], joined from the lengths of its groups.

    Parameters
    ----------
    lengths : sequence of sequence of float
        As of :func:`single_lengths` [(N m s)^0.5].
    """
    return [math.hypot(*every) for every in zip(*lengths, strict=True)]


def check_length(step: StepData, delta_q: Array, parts: Parts) -> None:
    """Raise StepIllPosed if delta_q (n_v,) [m, rad] is absurdly long in a group of the step.

    Parameters
    ----------
    step : StepData
    delta_q : ndarray, shape (n_v,)
    parts : sequence of (Group, StepData)
        The groups of the step.

    Raises
    ------
    StepIllPosed
    """
    relative = []
    for group, part in parts:
        moved = delta_q[group.coordinates]
        norm = norm_of(part)
        of_loads = norm.of_impulses(single_loads(part))
        most = 0.1 * ILL_POSED * float(of_loads.max())  # a tenth is for rounding
        length = norm.of_displacement(moved)
        if not (MIDDLE[0] < most < MIDDLE[1] and length <= most):
            relative.append(relative_length(part, moved))
    longest = max(relative, key=lambda r: math.inf if math.isnan(r) else r, default=0.0)
    if not longest <= ILL_POSED:
        raise StepIllPosed(step, delta_q, longest)


def relative_length(step: StepData, delta_q: Array) -> float:
    """||delta_q||_H over the largest step that the loads or a single row ask for alone [-].

    It is compared with ``ILL_POSED`` for each group of a step by itself, lest a heavy body hide
    what is absurd in a light one.

    The length that delta_q is divided by is the largest of several in the H norm. Some are those of
    the unconstrained steps that the targets, tau_a, tau_u and a user's cost would each cause alone
    (together they may cancel, but for rounding). The last is max_i b_i / ||a_i||, in the norm of
    H^-1: the shortest step that satisfies the row i alone (a body pushed out of penetration moves
    however small g is). Without loads and penetration, zero is the optimum.

    Parameters
    ----------
    step : StepData
    delta_q : ndarray, shape (n_v,)

    Returns
    -------
    float
    """
    form = standard_form(step)
    norm = norm_of(step)
    b = np.maximum(form.b, 0.0)
    of_cost = [] if step.extra.cost is None else [step.extra.cost[1]]
    parameters = np.concatenate([step.delta_q_bar_a, step.tau_a, step.tau_u, *of_cost, b])
    # All lengths are linear in these and delta_q. Of subnormal loads h tau could be zero.
    scale = 2.0 ** min(-math.frexp(np.abs(parameters).max(initial=0.0))[1], 1000)
    pushed = b > 0
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        push_out = scale * b[pushed] / norm.of_impulses(form.A[pushed])
        of_loads = norm.of_impulses(single_loads(step, scale)).max()
        scene_length = float(max(of_loads, push_out.max(initial=0.0)))
        length = norm.of_displacement(scale * delta_q)
        if scene_length:
            return length / scene_length
        return 0.0 if length == 0 else float("inf")


def correct_digits(step: StepData, delta_q: Array, exact_delta_q: Array) -> float:
    """Correct digits of a displacement [-], 0 to 16.

    Parameters
    ----------
    step : StepData
        SI units.
    delta_q, exact_delta_q : ndarray, shape (n_v,)
        The answer, and the optimum [m, rad].
    """
    parts = group_steps(step)
    norms = [(group.coordinates, norm_of(part)) for group, part in parts]
    off, moved = (
        math.hypot(*(norm.of_displacement(v[c]) for c, norm in norms))
        for v in (delta_q - exact_delta_q, exact_delta_q)
    )
    softest = min(part.H.diagonal().min() for _, part in parts)
    return digits_of_error(off / _length(moved, over_groups(single_lengths(parts)), softest))
