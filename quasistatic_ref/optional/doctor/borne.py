"""Whether the contacts of a state can bear a body: the linear program of equilibrium."""

from typing import NamedTuple

import numpy as np

from quasistatic_ref.optional.doctor.artifacts import LIGHT
from quasistatic_ref.optional.doctor.compared import FARTHEST, SHORT
from quasistatic_ref.optional.doctor.equilibrium import missing_force, statics, unsqueezed
from quasistatic_ref.optional.doctor.start import Start, least, translations
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import Array, Mask, StepData


class AtRest(NamedTuple):
    """A step whose targets are where its joints are, and its contacts that touch.

    Parameters
    ----------
    step : StepData
    touching : ndarray of bool, shape (n_c,)
        A gap below 1e-6 of the smaller shape counts as none.
    bodies : tuple of str, length n_u
        The body of each un-actuated coordinate.
    masses : ndarray, shape (n_u,)
        Theirs [kg].
    free : list of slice
        Un-actuated coordinates that translate a free body.
    """

    step: StepData
    touching: Mask
    bodies: tuple[str, ...]
    masses: Array
    free: list[slice]

    def without_squeeze(self) -> Array:
        """Normal forces, shape (n_c,) [N], that bear the loads and are no mere squeeze."""
        no_limit = np.full(self.step.contacts.n_c, np.inf)
        normal = statics(self.step, self.touching, no_limit, self.masses, self.free).normal
        return unsqueezed(self.step, normal)


def at_rest(start: Start, q: Array, contacts: Contacts) -> AtRest:
    """A step whose targets are where its joints are, under the loads of t = 0.

    Parameters
    ----------
    start : Start
    q : ndarray, shape (n_q,)
    contacts : Contacts
        At q.
    """
    system = start.system
    simulator = start.simulator
    load = simulator.generalised_force(q, 0.0)
    step = simulator.step_under(q, q[: system.n_q_a], load, contacts)
    names = tuple(c.joint.partition("/")[0] for c in system.coordinates[step.n_a :])
    sizes = np.repeat([least(pair) for pair in start.pairs], [pair.n_c for pair in start.pairs])
    touching = contacts.phi <= SHORT * np.minimum(sizes, FARTHEST)
    masses = np.array([system.mass(name) for name in names])
    return AtRest(step, touching, names, masses, translations(system))


def borne(start: Start, q: Array, contacts: Contacts, name: str, squeezed: bool = True) -> bool:
    """Whether forces in the cones of touching contacts bear a body's weight.

    Lever arms count. A force below 1e-3 of the body's weight counts as none.

    Parameters
    ----------
    start : Start
    q : ndarray, shape (n_q,)
    contacts : Contacts
        At q.
    name : str
        Of a free body.
    squeezed : bool
        Whether contacts may squeeze the body: by a squeeze of any size a guide bears any load.
        Otherwise they press by what bears the load and no more.
    """
    rest = at_rest(start, q, contacts)
    at_most = np.full(contacts.n_c, np.inf) if squeezed else rest.without_squeeze()
    missing = missing_force(rest.step, rest.touching, at_most, rest.masses, rest.free)
    lacks = float(np.linalg.norm(missing[[x == name for x in rest.bodies]]))
    return lacks <= LIGHT * start.system.mass(name) * start.g
