"""Steps that are degenerate by construction: most slacks and coordinates are zero, or tie."""

import numpy as np

from quasistatic_ref import Extra
from quasistatic_ref.lab.scenes.contacts import GRAVITY, repeated
from quasistatic_ref.lab.scenes.loads import loaded_pile

CONES = ("pyramid", "product", "facets-6", "facets-8", "frictionless")


def degenerate_step(seed):
    """A pile of one to three boxes, pushed along an axis or not at all; the seed decides.

    Gaps are equal everywhere, some contacts occur twice, and some forces are zero. The lowest box
    may be between two stops.

    Parameters
    ----------
    seed : int
    """
    rng = np.random.default_rng([seed, 3])
    boxes = int(rng.choice([1, 1, 2, 3]))
    mass = float(rng.choice([0.2, 0.5, 1.0]))
    pile = loaded_pile([mass] * boxes, float(rng.choice([0.01, 2.0**-6]))).step
    corners = np.arange(pile.contacts.n_c)
    twice = corners[rng.random(len(corners)) < rng.choice([0.0, 0.2])]
    index = [*corners, *twice]
    alike = {
        "phi": rng.choice([0.0, 0.0, 1e-4, 2.0**-13, -1e-5]),
        "mu_v": rng.choice([0.0, 0.3, 0.5]),
        "mu_omega": rng.choice([0.0, 0.01]),
        "rows": rng.choice([4, 6]),
    }
    of_each = {name: np.full(len(index), value) for name, value in alike.items()}
    force = pile.tau_u * rng.choice([0.0, 1.0])
    axis = int(rng.integers(6))
    size = mass * GRAVITY * (1.0 if axis < 3 else 0.01)
    force[axis] += size * rng.choice([0.0, 0.2, 0.5, 2.0]) * rng.choice([-1.0, 1.0])
    step = pile.replace(
        contacts=repeated(pile.contacts, index, **of_each),
        tau_u=force,
        cone=str(rng.choice(CONES)),
    )
    if rng.random() < 0.5:
        return step
    along_x = np.eye(1, step.n_v)
    room = np.full(2, max(alike["phi"], 0.0))
    stops = Extra(("ahead", "behind"), np.vstack([-along_x, along_x]), -room)
    return step.replace(extra=stops)
