"""Contact forces by compliance: one answer, whatever should not matter.

On a step (random and degenerate: duplicated contacts, penetration, coefficients of 0, masses 1e9
apart; one polyhedral cone after the other):

- every backend and none, plain and fast, cold, and contacts in another order give equal bits;
- so does the definition, in which what each contact gives way by is solved for, too;
- so do fractions, by which the optimum is proved (tests/oracles/compliant_forces.py; the pyramid).
"""

import numpy as np

from quasistatic_ref import (
    QuasistaticError,
    contact_forces,
    solve_step,
)
from quasistatic_ref.certify.optimum import step_optimum
from quasistatic_ref.optional.forces.forces import WRENCH, defined_optimum
from quasistatic_ref.step.cones import PYRAMID
from tests.made import repeated
from tests.oracles.compliant_forces import forces as independent_forces
from tests.oracles.random_steps import drawn

BACKENDS = ("clarabel", "osqp", "piqp", "daqp", "scs", "none")
CONES = (PYRAMID, "product", "facets-6", "frictionless")
LOST = 1e-6
UNITS = (1.0, 1e-3, 1e3)
"""[m]"""


def differences(step, oracle):
    """Of each check 1 if it fails and 0 if it holds; a check that was not made is not there."""
    first = solve_step(step, "none")
    forces = first.forces
    c = first.compliant.compliance
    k = step.contacts
    bits = forces.tobytes()
    order = np.random.default_rng(0).permutation(k.n_c)
    moved = contact_forces(step.replace(contacts=repeated(k, order))).wrench
    others = [solve_step(step, name).forces.tobytes() for name in BACKENDS[:-1]]
    held = {
        "backends": set(others) == {bits},
        "fast": solve_step(step, "daqp").forces.tobytes() == bits,
        "cold": contact_forces(step).wrench.tobytes() == bits,
        "permuted": moved.tobytes() == forces[order].tobytes(),
    }
    if len(set(c.tolist())) == 1:
        held["definition"] = defined_optimum(step, c[0])[0][:, WRENCH].tobytes() == bits
        if oracle and step.cone == PYRAMID and not step.extra.names:
            held["independent"] = independent_forces(step, c[0]).tobytes() == bits
    return {name: int(not holds) for name, holds in held.items()}


def random_steps(count):
    """The first random steps that have a solution."""
    seed = found = 0
    while found < count:
        step = drawn(seed).replace(cone=CONES[seed % len(CONES)])
        seed += 1
        try:
            step_optimum(step)
        except QuasistaticError:
            continue
        found += 1
        yield f"random {seed - 1}", step
