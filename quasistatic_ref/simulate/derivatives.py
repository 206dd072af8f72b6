"""The derivatives of a step: of the map q+ = F(q, q_bar_a, tau, parameters).

In tangent coordinates on both sides: column j of dq_dq is the derivative at eps = 0 of
F(q (+) eps e_j) (-) F(q). The formula is exact, and evaluated in float64 from the exact optimum and
its working set. docs/derivatives.md says what the numbers mean, how right they are, and where
there are none.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from quasistatic_ref.certify import reason
from quasistatic_ref.certify.optimum_rates import DataRates, Equations, OptimumRates, parameters
from quasistatic_ref.certify.reason import Reason
from quasistatic_ref.certify.touching import Touching, touching_rows
from quasistatic_ref.contact.contact_rates import contact_rates
from quasistatic_ref.contact.couples import couples
from quasistatic_ref.errors import InputError
from quasistatic_ref.model.mass_rates import MassRates
from quasistatic_ref.model.motion_rates import MotionRates
from quasistatic_ref.model.tangent import half_turns, sum_rates
from quasistatic_ref.plain import Plain
from quasistatic_ref.simulate.data_rates import data_rates
from quasistatic_ref.simulate.kink_reasons import geometry_reasons
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.row_rates import RowRates
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, Mask
from quasistatic_ref.tolerances import ON_RIM

FIELDS = (
    "dq_dq",
    "dq_dq_bar_a",
    "dq_dtau",
    "dq_dmu_v",
    "dq_dmu_omega",
    "dq_dK_q",
    "dq_dh",
    "dq_dmasses",
)


@dataclass(frozen=True, eq=False)
class OneSided:
    """What the derivatives along a direction are made of; see :meth:`Derivatives.along`.

    Parameters
    ----------
    equations : Equations
    data : DataRates
        By all parameters, in the order of the fields.
    carried, onward : ndarray, shape (n_v, n_v)
        Derivatives of q (+) delta_q by q and by delta_q.
    """

    equations: Equations
    data: DataRates
    carried: Array
    onward: Array


@dataclass(frozen=True, eq=False)
class Derivatives(Plain):
    """Derivatives of the configuration after a step, in tangent coordinates on both sides.

    Columns without a derivative are NaN, and `reasons` says why.

    Parameters
    ----------
    dq_dq, dq_dtau : ndarray, shape (n_v, n_v)
        By q, and by the external generalised force [per m or rad, per N or N m].
    dq_dq_bar_a : ndarray, shape (n_v, n_a)
        By the target of the actuated coordinates [per m or rad].
    dq_dmu_v, dq_dmu_omega : ndarray, shape (n_v, pairs)
        By the coefficients of friction of each pair [per 1, per m].
    dq_dK_q : ndarray, shape (n_v, n_a)
        By the diagonal of K_q [per N/m or N m/rad].
    dq_dh : ndarray, shape (n_v,)
        By the time step [per s].
    dq_dmasses : ndarray, shape (n_v, L)
        By the mass of each link, its inertia about its centre of mass staying [per kg].
    differentiable : bool
        Whether all of them exist.
    reasons : tuple of Reason
        Why those that are NaN do not; empty if all exist.
    result : StepResult
        The step.
    """

    dq_dq: Array
    dq_dq_bar_a: Array
    dq_dtau: Array
    dq_dmu_v: Array
    dq_dmu_omega: Array
    dq_dK_q: Array
    dq_dh: Array
    dq_dmasses: Array
    differentiable: bool
    reasons: tuple[Reason, ...]
    result: StepResult
    _parts: OneSided = field(compare=False, repr=False)

    def along(self, **directions: Array | float) -> Array:
        """The one-sided derivative of q+ along a direction, shape (n_v,).

        It exists where the only reasons are rows that touch without load.

        Parameters
        ----------
        directions : ndarray or float
            By names of fields without ``dq_d``, what each parameter changes by: ``along(q=e)``, or
            ``along(q_bar_a=e, mu_v=[0.1, 0])``; shapes (n_v,), (n_a,), ... as the fields have
            columns, in their units [of the parameter].

        Returns
        -------
        ndarray, shape (n_v,)

        Raises
        ------
        InputError
            If a name or a shape is wrong, or the reasons are others.
        """
        direction = self._direction(directions)
        asked = {f"dq_d{name}" for name, value in directions.items() if np.any(value)}
        for found in self.reasons:
            if found.kind != reason.WEAK and asked & set(found.fields):
                raise InputError(
                    "has no one-sided derivative here: " + found.sentence, field="along"
                )
        parts = self._parts
        one = _combined(parts.data, direction)
        rates = parts.equations.rates(one)
        x = parts.equations.one_sided(rates, 0)
        return np.asarray(parts.onward @ x + parts.carried @ direction[: len(x)])

    def _direction(self, directions: dict[str, Array | float]) -> Array:
        names = [name.removeprefix("dq_d") for name in FIELDS]
        parts = []
        for name in directions:
            if name not in names:
                raise InputError(f"must be one of {', '.join(names)}", field="along", value=name)
        for name in names:
            columns = getattr(self, f"dq_d{name}").reshape(len(self.dq_dq), -1).shape[1]
            value = np.ravel(np.asarray(directions.get(name, np.zeros(columns)), dtype=np.float64))
            if value.shape != (columns,):
                raise InputError(
                    f"must have shape ({columns},)", field=f"along.{name}", value=value.shape
                )
            parts.append(value)
        return np.concatenate(parts)


def _combined(data: DataRates, direction: Array) -> DataRates:
    """The rates along one direction, as those of a single parameter."""
    load, motion = (data.load @ direction)[:, None], (data.motion @ direction)[:, :, None]
    terms = np.array([data.terms @ np.abs(direction)])
    return DataRates(load, motion, terms, lambda y: (data.pull(y) @ direction)[:, None])


def derivatives(
    simulator: Simulator, q: Array, q_bar_a: Array, force: Array | float = 0.0
) -> Derivatives:
    """The derivatives of the step that a simulator would take.

    Parameters
    ----------
    simulator : Simulator
        Of a polyhedral cone, without an extension.
    q : ndarray, shape (n_q,)
    q_bar_a : ndarray, shape (n_q_a,)
    force : ndarray, shape (n_v,), optional
        External generalised force besides gravity, which does not depend on q [N, N m].

    Returns
    -------
    Derivatives

    Raises
    ------
    InputError
        If the cone is no polyhedron, or the simulator has an extension.
    StepNotSolved
        As :meth:`~quasistatic_ref.simulate.simulator.Simulator.step` does.
    """
    if not cone(simulator.cone).polyhedral:
        raise InputError("must be a polyhedron for derivatives", field="cone", value=simulator.cone)
    if simulator.extension is not None:
        raise InputError("has no derivative: its rows may be any function of q", field="extension")
    q = np.asarray(q, dtype=np.float64)
    result = _certified(simulator, q, q_bar_a, force)
    system, step, x = simulator.system, result.step, result.solution.delta_q
    kinematics = system.kinematics(q)
    motion = MotionRates(kinematics, system.motion)
    kept = couples(simulator.pairs, result.points, kinematics.R, kinematics.t)
    contacts = step.contacts
    rates = contact_rates(kept, (contacts.d1, contacts.d2), motion.J)
    rows = RowRates(contacts.dense(), result.points, simulator.layout, rates, motion)
    data = data_rates(simulator, step, x, rows, MassRates(system, kinematics, motion))
    places = np.abs(np.stack([result.points.alpha, result.points.beta])).max(axis=(0, 2), initial=0)
    touching = touching_rows(step, result.solution, places)
    equations = Equations(touching)
    every = parameters(*data.values())
    found = equations.rates(every)
    ends = np.cumsum([part.load.shape[1] for part in data.values()])
    columns_of = zip([0, *ends[:-1].tolist()], ends.tolist(), strict=True)
    own = dict(zip(data, columns_of, strict=True))
    reasons = [
        *geometry_reasons(simulator, result, kept, rates, motion.J, touching),
        *_target_reasons(simulator, step.delta_q_bar_a),
        *_row_reasons(simulator, result, touching, found, own),
    ]
    by_q, onward = sum_rates(system.joints, x)
    columns = onward @ found.x
    columns[:, : system.n_v] += by_q
    bad = _forbidden(found, reasons, own)
    columns[:, bad] = np.nan
    shaped = {name: columns[:, slice(*place)] for name, place in own.items()}
    shaped["dq_dh"] = shaped["dq_dh"][:, 0]
    return Derivatives(
        **shaped,
        differentiable=not reasons,
        reasons=tuple(reasons),
        result=result,
        _parts=OneSided(equations, every, by_q, onward),
    )


def _certified(simulator: Simulator, q: Array, q_bar_a: Array, force: Array | float) -> StepResult:
    """The step with its exact optimum, whatever the simulator certifies."""
    result = simulator.step(q, q_bar_a, force)
    if result.solution.certificate.kind == "exact":
        return result
    solution = solve_step(result.step.replace(contacts=result.step.contacts.dense()), "none")
    q_next = simulator.system.integrate(q, solution.delta_q)
    return StepResult(q_next, solution.step, solution, result.points, result.seconds)


def _target_reasons(simulator: Simulator, change: Array) -> list[Reason]:
    names = half_turns(simulator.system.joints, change, ON_RIM)
    says = "the target is half a turn away, where (-) jumps"
    return [
        Reason(reason.HALF_TURN, (name,), ("dq_dq", "dq_dq_bar_a"), f"{name}: {says}")
        for name in names
    ]


def _row_reasons(
    simulator: Simulator,
    result: StepResult,
    touching: Touching,
    found: OptimumRates,
    places: dict[str, tuple[int, int]],
) -> list[Reason]:
    """Rows that stand in the way of some parameters."""
    names, row_names = result.step.contacts.name, cone(result.step.cone).row_names
    reasons = []

    def fields(bad: Mask) -> tuple[str, ...]:
        return tuple(name for name, place in places.items() if bad[slice(*place)].any())

    for contacts, bad in found.contradicts:
        where = tuple(names[j] for j in sorted(contacts))
        says = f"the equations of {_listed(where)} would contradict each other"
        reasons.append(Reason(reason.CONTRADICTION, where, fields(bad), says))
    for (j, i), bad in zip(touching.idle.tolist(), found.opens, strict=True):
        if bad.any():
            where = names[j], row_names[i]
            says = (
                f"row {row_names[i]} of {names[j]} touches without load: it holds on one side only"
            )
            reasons.append(Reason(reason.WEAK, where, fields(bad), says))
    touched = {names[j].rpartition("/")[0] for j in touching.contacts}
    for pair in simulator.pairs:
        for key, used in (("mu_v", True), ("mu_omega", pair.rows == 6)):
            if pair.name in touched and used and getattr(pair, key) == 0:
                says = f"{key} of {pair.name} is zero, cannot be smaller, and the pair touches"
                reasons.append(Reason(reason.ZERO_FRICTION, (pair.name,), (f"dq_d{key}",), says))
    return reasons


def _forbidden(
    found: OptimumRates, reasons: Sequence[Reason], places: dict[str, tuple[int, int]]
) -> Array:
    """Which columns have no derivative."""
    bad = np.asarray(found.opens.any(axis=0))
    for _, own in found.contradicts:
        bad = bad | own
    by_field = (reason.WEAK, reason.CONTRADICTION)
    for why in reasons:
        for name in why.fields if why.kind not in by_field else ():
            bad[slice(*places[name])] = True
    return np.asarray(bad)


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
