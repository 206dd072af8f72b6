"""The exact optimum of a step, rounded correctly to float64.

Numbers are computed as balls (a midpoint with a rigorous bound of its error) and, only where a ball
leaves a sign or a rounding open, as fractions.

delta_q and A'lam are unique, and correct rounding leaves no choice: they have the same bits
whatever the warm start was. lam and the working set are one of several possible choices where the
multipliers are not unique.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quasistatic_ref.certify.failures import StepInfeasible
from quasistatic_ref.certify.farkas import farkas_vector
from quasistatic_ref.certify.groups import Group, group_steps
from quasistatic_ref.certify.norm import Parts, check_length
from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.errors import InputError
from quasistatic_ref.exact.active_set import Combination, dual_active_set
from quasistatic_ref.exact.minimiser import LARGE
from quasistatic_ref.exact.program import ExactProgram
from quasistatic_ref.exact.refined import BearingRows
from quasistatic_ref.numbers.arrays import Array, read_only, without_warnings
from quasistatic_ref.parts import part as optional_part
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import own_inequalities


@dataclass(frozen=True, eq=False)
class ExactOptimum:
    """The optimum of min 1/2 x'Hx - g'x s.t. Ax >= b; every number is rounded correctly.

    Parameters
    ----------
    delta_q : ndarray, shape (n_v,)
        [m, rad].
    lam : ndarray, shape (m,)
        Basic multipliers [N s]: zero outside of the working set, positive on it, but those of
        equations.
    net : ndarray, shape (n_v,)
        A'lam [N s, N m s].
    working_set : tuple of int
        Rows in increasing order, independent, with positive multipliers where no equations.
    smallest_active_multiplier : float or None
        Smallest of lam [N s] on the working set, equations left out; None if there is no other.
    iterations : int
        Violated rows that were added to the warm start: zero if it was right.
    """

    delta_q: Array
    lam: Array
    net: Array
    working_set: tuple[int, ...]
    smallest_active_multiplier: float | None
    iterations: int


def form_optimum(form: ExactProgram, warm: Sequence[int] = ()) -> ExactOptimum | Combination:
    """The exact optimum, or an exact proof that there is none.

    Parameters
    ----------
    form : ExactProgram
    warm : sequence of int
        Rows that a solver found active, in order of preference; any rows will do.

    Returns
    -------
    ExactOptimum or Combination
    """
    bearing = _bearing_rows() if len(warm) > LARGE else None
    minimiser = dual_active_set(form, warm, bearing)
    if isinstance(minimiser, Combination):
        return minimiser
    working = minimiser.working
    lam = np.zeros(form.m)
    lam[list(working)] = minimiser.rounded(lambda m: m.y, form.h)
    pressed = [i for i in working if i >= form.equations]
    return ExactOptimum(
        delta_q=minimiser.rounded(lambda m: m.x),
        lam=lam,
        net=minimiser.rounded(lambda m: m.net.entries(), form.h),
        working_set=tuple(sorted(working)),
        smallest_active_multiplier=float(lam[pressed].min()) if pressed else None,
        iterations=minimiser.iterations,
    )


def _bearing_rows() -> BearingRows | None:
    """What finds the rows that bear in a QP; None where its part or its package is missing."""
    try:
        bearing: BearingRows = optional_part("bearing_rows")
    except (InputError, ImportError):
        return None
    return bearing


def step_optimum(step: StepData, warm: Sequence[int] = ()) -> ExactOptimum:
    """The exact optimum of Eq. :eq:`eq-13`, sought and proved for each of its groups by itself.

    Parameters
    ----------
    step : StepData
        SI units.
    warm : sequence of int
        Rows that a solver found active; see :func:`~quasistatic_ref.exact.active_set.warm_rows`.

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
        If the optimum of a group is absurdly long.
    """
    if not cone(step.cone).polyhedral:
        raise InputError(
            "has no rational optimum; use a polyhedral cone", field="cone", value=step.cone
        )
    parts = group_steps(step)
    starts = [group.within(warm) for group, _ in parts]
    optimum = optimum_by_groups(step, parts, starts)
    without_warnings(check_length, step, optimum.delta_q, parts)
    return optimum


def optimum_by_groups(
    step: StepData,
    parts: Parts,
    starts: Sequence[Sequence[int]],
    proofs: ProofCache | None = None,
    own: tuple[Array, Array] | None = None,
) -> ExactOptimum:
    """The exact optimum of a step, computed group by group, without a limit on its length.

    Parameters
    ----------
    step : StepData
    parts : sequence of (Group, StepData)
        Its groups.
    starts : sequence of sequence of int
        Of each group, counted in it: rows that a solver found active.
    proofs : ProofCache, optional
        Those of the step before; they become those of this step.
    own : (ndarray, ndarray), shapes (m_c, w) and (m,), optional [m]
        The step's ``own_inequalities``, where they are known.

    Raises
    ------
    StepInfeasible
    """
    proofs = ProofCache() if proofs is None else proofs
    A, b = own_inequalities(step) if own is None else own
    optima: list[tuple[Group, ExactOptimum]] = []
    for i, ((group, part), start) in enumerate(zip(parts, starts, strict=True)):
        optimum = proofs.kept(i, part, start)
        if optimum is None:
            rows = group.rows
            form = proofs.form(i, part, (A[rows[: part.offsets[-1]]], b[rows]))
            end = form_optimum(form, start)
            if isinstance(end, Combination):
                raise StepInfeasible(step, farkas_vector(step, form, end, group.rows))
            optimum = end
            proofs.keep(i, part, start, optimum)
        if part is step:
            return optimum
        optima.append((group, optimum))
    delta_q = np.zeros(step.n_v)
    net = np.zeros(step.n_v)
    lam = np.zeros(step.m)
    working: list[int] = []
    for group, optimum in optima:
        delta_q[group.coordinates] = optimum.delta_q
        net[group.coordinates] = optimum.net
        lam[group.rows] = optimum.lam
        working += group.rows[list(optimum.working_set)].tolist()
    each = [optimum for _, optimum in optima]
    multipliers = [optimum.smallest_active_multiplier for optimum in each]
    return ExactOptimum(
        delta_q=delta_q,
        lam=lam,
        net=net,
        working_set=tuple(sorted(working)),
        smallest_active_multiplier=min((v for v in multipliers if v is not None), default=None),
        iterations=sum(optimum.iterations for optimum in each),
    )


class ProofCache:
    """A cache of the last step's proofs, by group: equal data and start give the same proof.

    What it gives depends on nothing else, and so on no step before.
    """

    def __init__(self) -> None:
        # Of each group: what it was as a step, the rows that its search started from, the end.
        self._last: dict[int, tuple[StepData, list[int], ExactOptimum]] = {}
        self._forms: dict[int, StepProgram] = {}

    def form(self, i: int, part: StepData, own: tuple[Array, Array]) -> StepProgram:
        """The exact program of group i: with the rows of the last step's, if they are the same.

        Parameters
        ----------
        i : int
        part : StepData
        own : (ndarray, ndarray), shapes (m_c, w) and (m,) [m]
            Its ``own_inequalities``.
        """
        self._forms[i] = form = StepProgram(part, own).with_rows_of(self._forms.get(i))
        return form

    def kept(self, i: int, part: StepData, start: Sequence[int]) -> ExactOptimum | None:
        """The kept optimum of group i, if its data and start equal those of the last step."""
        if i not in self._last:
            return None
        last, begun, optimum = self._last[i]
        return optimum if begun == [*start] and part.same_as(last) else None

    def keep(self, i: int, part: StepData, start: Sequence[int], optimum: ExactOptimum) -> None:
        """Replace the kept proof of group i."""
        for array in (optimum.delta_q, optimum.lam, optimum.net):
            read_only(array)
        self._last[i] = part, [*start], optimum
