"""Derivatives of the configuration after a step, as data, and along directions."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.optional.derivatives.step.optimum_rates import DataRates
from quasistatic_ref.optional.derivatives.step.reason import Reason
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.step.data import Array

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
    displacement : callable
        Rates of the data by one parameter -> how delta_q changes as that grows, shape (n_v,).
    data : DataRates
        By all parameters, in the order of the fields.
    carried, onward : ndarray, shape (n_v, n_v)
        Derivatives of q (+) delta_q by q and by delta_q [m, rad per m or rad].
    """

    displacement: Callable[[DataRates], Array]
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
        fields = {name: getattr(self, name) for name in FIELDS}
        widths = {name: value.size // len(self.dq_dq) for name, value in fields.items()}
        direction = directed(widths, directions, "along")
        used = {f"dq_d{name}" for name, value in directions.items() if np.any(value)}
        for found in self.reasons:
            if found.kind != reason.WEAK and used & set(found.fields):
                raise InputError(
                    "has no one-sided derivative here: " + found.sentence, field="along"
                )
        parts = self._parts
        x = parts.displacement(combined(parts.data, direction))
        return np.asarray(parts.onward @ x + parts.carried @ direction[: len(x)])


def directed(
    widths: Mapping[str, int], directions: Mapping[str, Array | float], where: str
) -> Array:
    """A direction of all parameters, by names, in the order of the fields, shape (P,).

    Parameters
    ----------
    widths : Mapping
        How many columns each field has.
    directions : Mapping
        As those of :meth:`Derivatives.along`.
    where : str
        What to call it in messages.

    Raises
    ------
    InputError
        If a name or a shape is wrong.
    """
    names = {name.removeprefix("dq_d"): width for name, width in widths.items()}
    for name in directions:
        if name not in names:
            raise InputError(f"must be one of {', '.join(names)}", field=where, value=name)
    parts = []
    for name, width in names.items():
        value = np.ravel(np.asarray(directions.get(name, np.zeros(width)), dtype=np.float64))
        if value.shape != (width,):
            raise InputError(
                f"must have shape ({width},)", field=f"{where}.{name}", value=value.shape
            )
        parts.append(value)
    return np.concatenate(parts)


def combined(data: DataRates, direction: Array) -> DataRates:
    """The rates along one direction, shape (P,), as those of a single parameter."""
    load, motion = (data.load @ direction)[:, None], (data.motion @ direction)[:, :, None]
    terms = np.array([data.terms @ np.abs(direction)])
    return DataRates(load, motion, terms, lambda y: (data.pull(y) @ direction)[:, None])
