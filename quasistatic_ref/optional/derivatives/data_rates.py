r"""How all data of a step change with what the step is a function of.

(R35): with x the displacement, each parameter changes the load :math:`\ell = g - H x` of Eq.
:eq:`eq-13` and the motion of the contacts, and with them the optimum as (R33) says.
"""

from collections.abc import Mapping
from functools import partial

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.model.mass_rates import MassRates
from quasistatic_ref.optional.derivatives.model.tangent import difference_rates
from quasistatic_ref.optional.derivatives.row_rates import RowRates
from quasistatic_ref.optional.derivatives.step.load_rates import load_rates
from quasistatic_ref.optional.derivatives.step.optimum_rates import DataRates
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.units import ScaledStep
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.friction import frame_jacobian

Places = Mapping[str, slice]
"""Which columns each field of the derivatives has, among all parameters."""


def data_rates(
    simulator: Simulator, step: StepData, x: Array, rows: RowRates, masses: MassRates
) -> tuple[DataRates, Places]:
    """The data's derivatives by all parameters, and which of them are of which field.

    Parameters
    ----------
    simulator : Simulator
    step : StepData
    x : ndarray, shape (n_v,)
        Its displacement [m, rad].
    rows : RowRates
    masses : MassRates
    """
    h = step.h
    n_a = step.n_a
    contacts = step.contacts
    pairs = simulator.pairs
    joints = simulator.system.joints
    target_by_q, target_by_next = difference_rates(joints, step.delta_q_bar_a)
    gravity = np.array(simulator.gravity)
    acts = np.concatenate([simulator.gravity_acts, np.ones(simulator.system.n_u)])[:, None]
    un_actuated = np.concatenate([np.zeros(n_a), x[n_a:]])

    by = load_rates(step, x)
    by_q = h * acts * masses.gravity_rates(gravity)
    by_q[:, :n_a] += by["delta_q_bar_a"] @ target_by_q
    if not simulator.system.constant_mass_matrix and n_a < step.n_v:
        by_q[n_a:] -= masses.inertial_force_rates(un_actuated)[n_a:] / h
    by_masses = h * acts * masses.by_masses(gravity)
    by_masses[n_a:] -= masses.by_masses(masses.moved @ un_actuated)[n_a:] / h
    unloaded = np.zeros((step.n_v, len(pairs)))
    loads = {
        "dq_dq": by_q,
        "dq_dq_bar_a": by["delta_q_bar_a"] @ target_by_next,
        "dq_dtau": by["tau"],
        "dq_dmu_v": unloaded,
        "dq_dmu_omega": unloaded,
        "dq_dK_q": by["K_q"],
        "dq_dh": by["h"],
        "dq_dmasses": by_masses,
    }
    load = np.concatenate([*loads.values()], axis=1)
    places = {}
    stop = 0
    for name, columns in loads.items():
        places[name] = slice(stop, stop + columns.shape[1])
        stop = places[name].stop

    parts = np.stack(frame_jacobian(contacts, contacts.J), axis=1)
    torsional = contacts.torsion[:, None, None]
    by_friction = {
        "dq_dmu_v": parts * np.array([0, 1, 1, 0])[:, None],
        "dq_dmu_omega": parts * np.array([0, 0, 0, 1])[:, None] * torsional,
    }
    of_pair = np.repeat(np.eye(len(pairs)), [pair.n_c for pair in pairs], axis=0)
    motion = np.zeros((contacts.n_c, 4, stop))
    motion[:, :, places["dq_dq"]] = rows.of_motion(x)
    terms = np.zeros(stop)
    terms[places["dq_dq"]] = rows.terms
    for name, J in by_friction.items():
        motion[:, :, places[name]] = (J @ x)[:, :, None] * of_pair[:, None]
        terms[places[name]] = (np.abs(J) @ np.abs(x)).max(initial=0.0)
    pull = partial(_exerted, rows, by_friction, of_pair, places, load.shape)
    return DataRates(load, motion, terms, pull), places


def _exerted(
    rows: RowRates,
    by_friction: Mapping[str, Array],
    of_pair: Array,
    places: Places,
    shape: tuple[int, ...],
    y: Array,
) -> Array:
    """Derivatives by all parameters of what multipliers y (n_c, 4) exert, shape (n_v, P)."""
    exerted = np.zeros(shape)
    exerted[:, places["dq_dq"]] = rows.pull(y)
    for name, J in by_friction.items():
        exerted[:, places[name]] = np.einsum("jiv,ji->vj", J, y) @ of_pair
    return exerted


def parameter_units(simulator: Simulator, step: StepData) -> dict[str, Array]:
    """The natural units of the parameters, by each field of the derivatives, shape (P,) of each.

    Coordinates and forces have those of the step, coefficients of friction 1 and its length, and
    stiffness, time step and masses are measured by their own size.
    """
    units = ScaledStep(step).units
    pairs = len(simulator.pairs)
    coordinate = units.size * units.coordinate
    return {
        "dq_dq": coordinate,
        "dq_dq_bar_a": coordinate[: step.n_a],
        "dq_dtau": units.size / (step.h * units.coordinate),
        "dq_dmu_v": np.ones(pairs),
        "dq_dmu_omega": np.full(pairs, units.size * units.length),
        "dq_dK_q": np.diag(step.K_q),
        "dq_dh": np.array([step.h]),
        "dq_dmasses": simulator.system.masses,
    }
