"""Whether the contacts of a state can bear a body: the linear program of equilibrium."""

import numpy as np

from quasistatic_ref.optional.doctor.compared import LIGHT, SHORT
from quasistatic_ref.optional.doctor.equilibrium import missing_force
from quasistatic_ref.optional.doctor.start import Start, least
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import Array


def borne(start: Start, q: Array, contacts: Contacts, name: str) -> bool:
    """Whether forces in the cones of touching contacts bear a body's weight at q, shape (n_q,).

    Lever arms count. A gap below 1e-6 of the smaller shape counts as none, and so does a force
    below 1e-3 of the body's weight.
    """
    system = start.system
    simulator = start.simulator
    at_rest = q[: system.n_q_a]
    step = simulator.step_under(q, at_rest, simulator.generalised_force(q, 0.0), contacts)
    names = [c.joint.partition("/")[0] for c in system.coordinates[step.n_a :]]
    sizes = np.repeat([least(pair) for pair in start.pairs], [pair.n_c for pair in start.pairs])
    touching = contacts.phi <= SHORT * np.minimum(sizes, 1.0)
    at_most = np.full(contacts.n_c, np.inf)
    missing = missing_force(step, touching, at_most, np.array([system.mass(x) for x in names]))
    lacks = float(np.linalg.norm(missing[[x == name for x in names]]))
    return lacks <= LIGHT * system.mass(name) * start.g
