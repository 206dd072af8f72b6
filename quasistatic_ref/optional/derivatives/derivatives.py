"""The derivatives of a step: of the map q+ = F(q, q_bar_a, tau, parameters).

In tangent coordinates on both sides: column j of dq_dq is the derivative at eps = 0 of
F(q (+) eps e_j) (-) F(q). They are differences of exact steps; docs/derivatives.md says how right
they are, and where there are none.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import InputError, check_kind
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, checked_array, checked_numbers
from quasistatic_ref.optional.derivatives.column import Column, column
from quasistatic_ref.optional.derivatives.nearby import Nearby
from quasistatic_ref.optional.derivatives.reason import Reason
from quasistatic_ref.shown import Shown
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.simulator import Simulator, by_one_thread
from quasistatic_ref.step.cones import cone
from quasistatic_ref.text.plain import Plain

EVERY_STEP = ("q", "q_bar_a", "tau")
"""What changes from step to step."""


@dataclass(frozen=True, eq=False, repr=False)
class Sides(Plain, Shown):
    """The derivatives of q+ by one parameter, from both sides; NaN where they do not exist.

    Parameters
    ----------
    rate : ndarray, shape (n_v, P)
        The derivatives [m or rad, per unit of the parameter].
    below, above : ndarray, shape (n_v, P)
        The one-sided derivatives, the parameter falling and rising [m or rad, per unit of it]; NaN
        where no two differences agree on one, as where a kink is nearer than the smallest.
    holds : ndarray, shape (P,)
        How far each column was compared with steps on either side [of the parameter]: there may be
        a kink beyond.
    """

    rate: Array
    below: Array
    above: Array
    holds: Array


@dataclass(frozen=True, eq=False, repr=False)
class Derivatives(Plain, Shown):
    """Derivatives of the configuration after a step, in tangent coordinates on both sides.

    Columns without a derivative are NaN, and `reasons` says why.

    Parameters
    ----------
    by : dict of str to Sides
        By each parameter that was asked for, from both sides.
    reasons : tuple of Reason
        Why those that are NaN do not exist; empty if all exist.
    result : StepResult
        The step.
    """

    by: dict[str, Sides]
    reasons: tuple[Reason, ...]
    result: StepResult
    _near: Nearby = field(compare=False, repr=False)

    @property
    def differentiable(self) -> bool:
        """Whether all derivatives that were asked for exist."""
        return not self.reasons

    @property
    def dq_dq(self) -> Array:
        """The derivative of q+ by q, shape (n_v, n_v) [per m or rad]."""
        return self._rate("q")

    @property
    def dq_dq_bar_a(self) -> Array:
        """The derivative of q+ by the target q_bar_a, shape (n_v, n_a) [per m or rad]."""
        return self._rate("q_bar_a")

    @property
    def dq_dtau(self) -> Array:
        """The derivative of q+ by the external force tau, shape (n_v, n_v) [per N or N m]."""
        return self._rate("tau")

    @property
    def dq_dmu_v(self) -> Array:
        """The derivative of q+ by each pair's mu_v, shape (n_v, pairs) [per 1]."""
        return self._rate("mu_v")

    @property
    def dq_dmu_omega(self) -> Array:
        """The derivative of q+ by each pair's mu_omega, shape (n_v, pairs) [per m]."""
        return self._rate("mu_omega")

    @property
    def dq_dK_q(self) -> Array:
        """The derivative of q+ by the diagonal of K_q, shape (n_v, n_a) [per N/m or N m/rad]."""
        return self._rate("K_q")

    @property
    def dq_dh(self) -> Array:
        """The derivative of q+ by the time step h, shape (n_v,) [per s]."""
        return np.asarray(self._rate("h")[:, 0])

    @property
    def dq_dmasses(self) -> Array:
        """The derivative of q+ by each link's mass, its inertia fixed, shape (n_v, L) [per kg]."""
        return self._rate("masses")

    def along(self, **directions: ArrayLike) -> Array:
        """The one-sided derivative of q+ along a direction, shape (n_v,).

        It is one column, whatever was asked for.

        Parameters
        ----------
        directions : ndarray or float
            By the names of parameters, what each changes by: ``along(q=e)``, or
            ``along(q_bar_a=e, mu_v=[0.1, 0])``; shapes (n_v,), (n_a,), ... as the fields have
            columns, in their units [of the parameter].

        Returns
        -------
        ndarray, shape (n_v,)

        Raises
        ------
        InputError
            If a name or a shape is wrong, a number is not finite, a step on that side is
            refused, or no two differences agree on a slope.
        """
        found, size = directed(self._near, directions)
        if np.isnan(found.above).any():
            why = found.problem or "a parameter of zero cannot fall"
            problem = f"has no one-sided derivative here that two differences agree on: {why}"
            raise InputError(problem, field="along")
        return size * found.above

    def _rate(self, name: str) -> Array:
        if name not in self.by:
            problem = f"was not asked for; pass by=({name!r}, ...) to derivatives"
            raise InputError(problem, field=f"dq_d{name}")
        return self.by[name].rate


def derivatives(
    simulator: Simulator,
    q: ArrayLike,
    q_bar_a: ArrayLike,
    force: ArrayLike | None = 0.0,
    by: Iterable[str] = EVERY_STEP,
) -> Derivatives:
    """The derivatives of the step that a simulator would take.

    Each column takes four exact steps, and up to sixteen at a kink.

    Parameters
    ----------
    simulator : Simulator
        Of a polyhedral cone, without an extension.
    q : array_like, shape (n_q,)
    q_bar_a : array_like, shape (n_q_a,)
    force : array_like, shape (n_v,), optional
        External generalised force in addition to gravity, which does not depend on q [N, N m].
    by : iterable of str
        The parameters: ``q``, ``q_bar_a``, ``tau``, ``mu_v``, ``mu_omega``, ``K_q``, ``h``,
        ``masses``.

    Returns
    -------
    Derivatives

    Raises
    ------
    InputError
        If the cone is no polyhedron, the simulator has an extension, or a parameter is unknown.
    StepNotSolved
        As :meth:`~quasistatic_ref.simulate.simulator.Simulator.step` does.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin")
    >>> simulator, q = scenario.simulator(), scenario.system.q_start
    >>> rates = qr.derivatives(simulator, q, [])
    >>> rates.differentiable
    True
    """
    check_derivable(simulator)
    near = Nearby(simulator, q, q_bar_a, force)
    check_kind(by, Iterable, "by", "names of parameters")
    by = (by,) if isinstance(by, str) else tuple(by)
    for name in by:
        check_name(near, name, "by")
    with by_one_thread(simulator.system):
        columns = {name: _columns(near, name) for name in by}
    sides = {name: _sides(near, name, each) for name, each in columns.items()}
    return Derivatives(sides, reasons_of(columns), near.result, near)


def reasons_of(columns: Mapping[str, Sequence[Column]]) -> tuple[Reason, ...]:
    """Why some columns do not exist, by their parameters: each reason once."""
    fields: dict[tuple[tuple[str, ...], tuple[str, ...], str], dict[str, None]] = {}
    for name, each in columns.items():
        for one in each:
            if one.problem:
                why = one.rows, one.points, one.problem
                fields.setdefault(why, {})[f"dq_d{name}"] = None
    return tuple(Reason(tuple(names), *why) for why, names in fields.items())


def directed(near: Nearby, directions: Mapping[str, ArrayLike]) -> tuple[Column, float]:
    """The column of a direction that is scaled to the parameters' sizes, and that scale.

    Raises
    ------
    InputError
        If a name or a shape is wrong, or a number is not finite.
    """
    changes = {}
    for name, value in directions.items():
        check_name(near, name, "along")
        sizes = near.sizes[name]
        where = f"along.{name}"
        numbers = checked_numbers(value, where, InputError)
        if sizes.shape == (1,) and numbers.shape == ():
            numbers = numbers[None]
        change = checked_array(numbers, where, sizes.shape, InputError)
        if change.any():
            changes[name] = change
    scale = max(
        [np.abs(change / near.sizes[name]).max() for name, change in changes.items()] or [1.0]
    )
    with by_one_thread(near.simulator.system):
        return column(near, {name: change / scale for name, change in changes.items()}), scale


def check_name(near: Nearby, name: str, where: str) -> None:
    """Refuse what is no parameter of a step: InputError."""
    if name not in near.sizes:
        raise InputError(f"must be one of {', '.join(near.sizes)}", field=where, value=name)


def check_derivable(simulator: Simulator) -> None:
    """Refuse what has no derivatives; InputError as of :func:`derivatives`."""
    check_kind(simulator, Simulator, "simulator", "a Simulator")
    if not isinstance(simulator.system, System):
        problem = "has no derivatives where MuJoCo moves it; write its bodies as URDFs"
        raise InputError(problem, field="system", value=type(simulator.system).__name__)
    if not cone(simulator.cone).polyhedral:
        raise InputError("must be a polyhedron for derivatives", field="cone", value=simulator.cone)
    if simulator.law != CONVEX:
        problem = f'must be "{CONVEX}" for derivatives, which are those of one convex step'
        raise InputError(problem, field="law", value=simulator.law)
    if simulator.extension is not None:
        # A scenario's extension names the fields of bodies that it is made of.
        field = getattr(simulator.extension, "fields", ("extension",))[0]
        why = "its rows may be any function of q"
        if field != "extension":
            why = "derivatives are of contacts alone; leave it out of the tables of bodies"
        raise InputError(f"has no derivative: {why}", field=field)


def _columns(near: Nearby, name: str) -> list[Column]:
    """The derivative columns of a parameter, each for a change of the parameter's size."""
    return [column(near, {name: change}) for change in np.diag(near.sizes[name])]


def _sides(near: Nearby, name: str, columns: Sequence[Column]) -> Sides:
    """The columns of a parameter as matrices, per unit of it."""
    sizes = near.sizes[name]
    shape = (len(sizes), 3, near.result.step.n_v)
    each = np.reshape([one[:3] for one in columns], shape)
    rate, below, above = each.transpose(1, 2, 0) / sizes
    return Sides(rate, below, above, sizes * [one.holds for one in columns])
