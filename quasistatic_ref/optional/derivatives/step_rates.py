"""How everything that a step is made of changes, at one configuration."""

from collections.abc import Iterable

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.contact.contact_rates import contact_rates
from quasistatic_ref.optional.derivatives.contact.couples import couples
from quasistatic_ref.optional.derivatives.data_rates import data_rates, parameter_units
from quasistatic_ref.optional.derivatives.model.mass_rates import MassRates
from quasistatic_ref.optional.derivatives.model.motion_rates import MotionRates
from quasistatic_ref.optional.derivatives.model.tangent import sum_rates
from quasistatic_ref.optional.derivatives.row_rates import RowRates
from quasistatic_ref.optional.derivatives.step.reason import Obstacle, Reason
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.simulator import Simulator


class StepRates:
    """The rates of a step at its displacement.

    Parameters
    ----------
    simulator : Simulator
    q : ndarray, shape (n_q,)
    result : StepResult
        The step from q.

    Attributes
    ----------
    x : ndarray, shape (n_v,)
        The displacement [m, rad].
    motion : MotionRates
    couples : list of Couple
        The contacts.
    contacts : Rates
    data : DataRates
        By all parameters.
    places : dict of str to slice
        Which columns of them each field of the derivatives has.
    units : ndarray, shape (P,)
        Their natural units.
    carried, onward : ndarray, shape (n_v, n_v)
        Derivatives of q (+) delta_q by q and by delta_q.
    far : ndarray, shape (n_c,)
        How far the closest points are from the world's origin [m].
    """

    def __init__(self, simulator: Simulator, q: Array, result: StepResult) -> None:
        self.result = result
        system = simulator.system
        step = result.step
        points = result.points
        self.x = x = result.solution.delta_q
        kinematics = system.kinematics(q)
        self.motion = MotionRates(kinematics, system.column_map)
        self.couples = couples(simulator.pairs, points, kinematics.R, kinematics.t)
        self.contacts = contact_rates(self.couples, self.motion.J)
        rows = RowRates(step.contacts, points, simulator.layout, self.contacts, self.motion)
        masses = MassRates(system, kinematics, self.motion)
        self.data, self.places = data_rates(simulator, step, x, rows, masses)
        units = parameter_units(simulator, step)
        self.units = np.concatenate([units[name] for name in self.places])
        self.carried, self.onward = sum_rates(system.joints, x)
        both = np.abs(np.stack([points.alpha, points.beta]))
        self.far: Array = both.max(axis=(0, 2), initial=0.0)

    def obstacle(
        self, kind: str, where: tuple[str, ...], fields: Iterable[str], sentence: str
    ) -> Obstacle:
        """A reason for which no column of some fields exists."""
        columns = np.zeros(len(self.units), dtype=bool)
        for name in fields:
            columns[self.places[name]] = True
        return Obstacle(Reason(kind, where, tuple(fields), sentence), columns)
