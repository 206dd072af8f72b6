"""A group of a first step, and its program, by the functions of the plain path."""

import numpy as np

from quasistatic_ref.certify.groups import Group
from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.jacobian import ContactGeometry
from quasistatic_ref.contact.pairs import ContactLayout
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.model.column_map import ColumnMap
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.optional.fast.joined import Masses
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.units import coordinate_units, natural_form
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import StandardForm, Units, standard_form


class SomeColumns(ColumnMap):
    """A column map restricted to some coordinates.

    Parameters
    ----------
    every : ColumnMap
    coordinates : ndarray of int, shape (n,)
        Ascending.
    """

    def __init__(self, every: ColumnMap, coordinates: Indices) -> None:
        self.some = np.flatnonzero(np.isin(every.owner, coordinates))
        owner = np.searchsorted(coordinates, every.owner[self.some])
        super().__init__(every.moves[:, :, self.some], owner, len(coordinates))

    def of_coordinates(self, columns: Array) -> Array:
        """Columns per unit of delta_q, shape (..., n_v), from `columns` (..., n_x) [m, rad]."""
        sums = np.zeros((*columns.shape[:-1], self.n_v))
        for x, v in enumerate(self.owner.tolist()):
            sums[..., v] += columns[..., x]
        return sums


class Plainly:
    """Forms the groups of a step one by one with the functions of the plain path.

    Parameters
    ----------
    simulator : Simulator
    q : ndarray, shape (n_q,)
    change : ndarray, shape (n_a,)
        delta_q_bar_a [m, rad].
    force : ndarray, shape (n_v,)
        In addition to gravity [N, N m].
    """

    def __init__(self, simulator: Simulator, q: Array, change: Array, force: Array) -> None:
        system = simulator.system
        self.simulator = simulator
        self.change = change
        self.kinematics = system.kinematics(q)
        self.points = simulator.closest_points(self.kinematics)
        self.tau = simulator.generalised_force(q, force)
        M_u = system.mass_blocks if system.constant_mass_matrix else system.M_u(q)
        self.masses = Masses(simulator.h, simulator.K_q, M_u)

    def step(self, group: Group) -> StepData:
        """The step of a group, checked."""
        simulator = self.simulator
        layout = simulator.layout
        c, k, *_ = group
        n_a = len(self.change)
        a = c[c < n_a]
        u = c[c >= n_a]
        names = tuple(layout.names[j] for j in k.tolist())
        links = layout.link_alpha[k], layout.link_beta[k]
        part = ContactLayout(names, *links, layout.mu_v[k], layout.mu_omega[k], layout.rows[k])
        columns = SomeColumns(simulator.system.column_map, c)
        now = self.kinematics
        of_group = Kinematics(now.R, now.t, now.columns[:, columns.some], columns)
        points = ClosestPoints._make(field[k] for field in self.points)
        return StepData(
            h=simulator.h,
            K_q=simulator.K_q[np.ix_(a, a)],
            M_u=self.masses.some(u - n_a),
            tau_a=self.tau[a],
            tau_u=self.tau[u],
            delta_q_bar_a=self.change[a],
            contacts=ContactGeometry(part, columns).contacts(points, of_group),
            cone=simulator.cone,
        )


def program_is_plain(
    step: StepData, units: Units, H: Array, program: tuple[Array, Array, Array]
) -> bool:
    """Whether H, and f = -g, A and b, are what the plain path makes of a step in natural units.

    Parameters
    ----------
    step : StepData
    units : Units
        Of all groups.
    H : ndarray, shape (n, n)
        In natural units [-], as all of these.
    program : (ndarray, ndarray, ndarray), shapes (n,), (m, n) and (m,)
        [-]
    """
    f, A, b = program
    units = units._replace(coordinate=coordinate_units(np.diag(step.H)))
    plain = natural_form(standard_form(step), units)
    return bool(bits(plain) == bits(StandardForm(H, -f, A, b)))
