r"""How all data of a step change with what the step is a function of.

(R35): with x the displacement, each parameter changes the load :math:`\ell = g - H x` of Eq.
:eq:`eq-13` and the motion of the contacts, and with them the optimum as (R33) says.
"""

from functools import partial

import numpy as np

from quasistatic_ref.optional.derivatives.model.mass_rates import MassRates
from quasistatic_ref.optional.derivatives.model.tangent import difference_rates
from quasistatic_ref.optional.derivatives.row_rates import RowRates
from quasistatic_ref.optional.derivatives.step.load_rates import load_rates
from quasistatic_ref.optional.derivatives.step.optimum_rates import DataRates
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.units import natural_units
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.friction import frame_jacobian


def data_rates(
    simulator: Simulator, step: StepData, x: Array, rows: RowRates, masses: MassRates
) -> dict[str, DataRates]:
    """The data's derivatives by each field of the derivatives, in their order.

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
    n_c = step.contacts.n_c
    joints = simulator.system.joints
    target_by_q, target_by_next = difference_rates(joints, step.delta_q_bar_a)
    gravity = np.array(simulator.gravity)
    acts = simulator.gravity_acts[:, None]
    un_actuated = np.concatenate([np.zeros(n_a), x[n_a:]])

    tau = np.concatenate([step.tau_a, step.tau_u])
    loads = load_rates(h, step.K_q, step.M_u, tau, step.delta_q_bar_a, x)
    by_target = loads["delta_q_bar_a"]
    load_q = h * acts * masses.gravity_rates(gravity)
    load_q[:, :n_a] += by_target @ target_by_q
    if not simulator.system.constant_mass_matrix and n_a < step.n_v:
        load_q[n_a:] -= masses.inertial_force_rates(un_actuated)[n_a:] / h
    weights = h * acts * masses.by_masses(gravity)
    weights[n_a:] -= masses.inertial_by_masses(un_actuated)[n_a:] / h
    return {
        "dq_dq": DataRates(load_q, rows.of_motion(x), rows.terms, rows.pull),
        "dq_dq_bar_a": _loads(by_target @ target_by_next, n_c),
        "dq_dtau": _loads(loads["tau"], n_c),
        **_coefficients(simulator, step, x),
        "dq_dK_q": _loads(loads["K_q"], n_c),
        "dq_dh": _loads(loads["h"], n_c),
        "dq_dmasses": _loads(weights, n_c),
    }


def parameter_units(simulator: Simulator, step: StepData) -> dict[str, Array]:
    """The natural units of the parameters, by each field of the derivatives, shape (P,) of each.

    Coordinates and forces have those of the step, coefficients of friction 1 and its length, and
    stiffness, time step and masses are measured by their own size.
    """
    units = natural_units(step)
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


def _loads(load: Array, n_c: int) -> DataRates:
    """Parameters that change the load alone."""
    none = np.zeros_like(load)
    return DataRates(load, np.zeros((n_c, 4, load.shape[1])), none[0], partial(_same, none))


def _same(value: Array, y: Array) -> Array:
    """What no multipliers change."""
    return value


def _coefficients(simulator: Simulator, step: StepData, x: Array) -> dict[str, DataRates]:
    """Parameters mu_v and mu_omega of each pair."""
    contacts = step.contacts
    pairs = simulator.pairs
    owner = np.repeat(np.arange(len(pairs)), [pair.n_c for pair in pairs])
    own = np.eye(len(pairs))[owner]  # (n_c, pairs)
    _, *parts = frame_jacobian(contacts, contacts.J)
    torsional = (contacts.rows == 6)[:, None]
    slides = np.stack([parts[0], parts[1], 0 * parts[2]], axis=1)
    spins = np.stack([0 * parts[0], 0 * parts[1], parts[2] * torsional], axis=1)
    none = np.zeros((step.n_v, len(pairs)))
    found = {}
    for name, J in (("dq_dmu_v", slides), ("dq_dmu_omega", spins)):
        motion = np.zeros((contacts.n_c, 4, len(pairs)))
        motion[:, 1:] = (J @ x)[:, :, None] * own[:, None]
        terms = (np.abs(J) @ np.abs(x)).max(axis=(0, 1), initial=0.0) * np.ones(len(pairs))
        found[name] = DataRates(none, motion, terms, partial(_exerted, J, own))
    return found


def _exerted(J: Array, own: Array, y: Array) -> Array:
    """What multipliers of slips and spin exert, pair by pair."""
    return np.asarray(np.einsum("jiv,ji->vj", J, y[:, 1:]) @ own)
