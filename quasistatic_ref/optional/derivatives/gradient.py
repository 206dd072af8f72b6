"""Derivatives of the configuration after a step, as data, and along directions."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.shown import Shown
from quasistatic_ref.numbers.arrays import Array, checked_numbers
from quasistatic_ref.optional.derivatives.data_rates import Places
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.optional.derivatives.step.optimum_rates import DataRates
from quasistatic_ref.optional.derivatives.step.reason import Obstacle, Reason
from quasistatic_ref.optional.derivatives.step_rates import StepRates
from quasistatic_ref.simulate.result import StepResult

BY: Final = {"dq_dq", "dq_dq_bar_a", "dq_dtau"}
"""The derivatives by what changes from step to step."""


@dataclass(frozen=True, eq=False, repr=False)
class Derivatives(Shown, Plain):
    """Derivatives of the configuration after a step, in tangent coordinates on both sides.

    Columns without a derivative are NaN, and `reasons` says why. So are those that are nearer to a
    kink than the `nearly` of :func:`~quasistatic_ref.optional.derivatives.derivatives.derivatives`.

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
        Whether all by q, q_bar_a and tau exist, and none is that near to a kink. One by another
        parameter may still be NaN, such as that by a friction coefficient of zero.
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
    _rates: StepRates = field(compare=False, repr=False)
    _along: Callable[[DataRates], Array] = field(compare=False, repr=False)

    def along(self, **directions: ArrayLike) -> Array:
        """The one-sided derivative of q+ along a direction, shape (n_v,).

        It exists where the only reasons are rows that touch without load, or nearly.

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
        direction = directed(self._rates.places, directions, "along")
        used = {f"dq_d{name}" for name, value in directions.items() if np.any(value)}
        for obstacle in self.reasons:
            if obstacle.kind not in reason.ONE_SIDED and used & set(obstacle.fields):
                problem = "has no one-sided derivative here: " + obstacle.sentence
                raise InputError(problem, field="along")
        x = np.ravel(self._along(combined(self._rates.data, direction)))
        return np.asarray(self._rates.onward @ x + self._rates.carried @ direction[: len(x)])


def gradient(
    rates: StepRates,
    x: Array,
    obstacles: Sequence[Obstacle],
    along: Callable[[DataRates], Array],
) -> Derivatives:
    """The derivatives of the configuration.

    Parameters
    ----------
    rates : StepRates
    x : ndarray, shape (n_v, P)
        The derivatives of delta_q.
    obstacles : sequence of Obstacle
        Why some of them do not exist.
    along : callable
        Rates of the data by one parameter -> how delta_q changes as that grows, n_v numbers.
    """
    columns = rates.onward @ x
    columns[:, : len(x)] += rates.carried
    for obstacle in obstacles:
        columns[:, obstacle.columns] = np.nan
    fields = {name: columns[:, place] for name, place in rates.places.items()}
    fields["dq_dh"] = fields["dq_dh"][:, 0]
    return Derivatives(
        **fields,
        differentiable=not any(BY & {*obstacle.reason.fields} for obstacle in obstacles),
        reasons=tuple(obstacle.reason for obstacle in obstacles),
        result=rates.result,
        _rates=rates,
        _along=along,
    )


def directed(places: Places, directions: Mapping[str, ArrayLike], where: str) -> Array:
    """A direction of all parameters, by names, in the order of the fields, shape (P,).

    Parameters
    ----------
    places : mapping of str to slice
        Which columns each field has.
    directions : Mapping
        As those of :meth:`Derivatives.along`.
    where : str
        What to call it in messages.

    Raises
    ------
    InputError
        If a name or a shape is wrong, or a number is not finite.
    """
    widths = {
        name.removeprefix("dq_d"): columns.stop - columns.start for name, columns in places.items()
    }
    for name in directions:
        if name not in widths:
            raise InputError(f"must be one of {', '.join(widths)}", field=where, value=name)
    parts = []
    for name, width in widths.items():
        field = f"{where}.{name}"
        value = checked_numbers(directions.get(name, np.zeros(width)), field, InputError)
        if value.shape != (width,) and not (width == 1 and value.shape == ()):
            raise InputError(f"must have shape ({width},)", field=field, value=value.shape)
        if not np.isfinite(value).all():
            raise InputError("must contain finite numbers only", field=field)
        parts.append(np.ravel(value))
    return np.concatenate(parts)


def combined(data: DataRates, direction: Array) -> DataRates:
    """The rates along one direction, shape (P,), as those of a single parameter."""
    load = (data.load @ direction)[:, None]
    motion = (data.motion @ direction)[:, :, None]
    terms = np.array([data.terms @ np.abs(direction)])
    return DataRates(load, motion, terms, lambda y: (data.pull(y) @ direction)[:, None])
