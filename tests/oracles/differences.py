"""Derivatives of steps by differences of exact steps: Richardson's combination of central ones."""

import numpy as np

from tests.tolerances import DIFFERENCE_OF_STEPS

STEPS = (1e-5, 1e-6, 1e-7, 3e-8)
"""Of differences [m or rad]: the first whose error is small counts, since a kink may be near."""


def unit(rng, n):
    """A random unit vector."""
    e = rng.normal(size=n)
    return e / np.linalg.norm(e)


def after(simulator, q_next, q, q_bar_a, force=0.0):
    """The end of a step, as seen from q_next."""
    return simulator.system.difference(q_next, simulator.step(q, q_bar_a, force).q)


def rate(function, step=1e-5):
    """Derivative at 0 of a function of one number: Richardson's of two central differences."""
    near, far = ((function(h) - function(-h)) / (2 * h) for h in (step, 2 * step))
    return (4 * near - far) / 3


def nearest(function, claimed, size):
    """How far some differences are from what is claimed, relative to a size: the first good one."""
    errors = []
    for step in STEPS:
        errors.append(np.abs(rate(function, step) - claimed).max() / (size or 1.0))
        if errors[-1] <= 1e-2 * DIFFERENCE_OF_STEPS:
            break
    return min(errors)


def wrong_by(simulator, q, q_bar_a, found, rng, direction=None):
    """How far dq_dq and dq_dq_bar_a are from differences along a direction each."""
    system, start = simulator.system, found.result.q
    e = unit(rng, system.n_v) if direction is None else direction
    whole = system.with_actuated(q, q_bar_a)

    def moved(t):
        return after(simulator, start, system.integrate(q, t * e), q_bar_a)

    errors = [nearest(moved, found.dq_dq @ e, np.abs(found.dq_dq).max())]
    if system.n_a:
        way = unit(rng, system.n_a)
        change = np.concatenate([way, np.zeros(system.n_u)])

        def aimed(t):
            target = system.integrate(whole, t * change)[: system.n_q_a]
            return after(simulator, start, q, target)

        size = np.abs(found.dq_dq_bar_a).max()
        errors.append(nearest(aimed, found.dq_dq_bar_a @ way, size))
    return tuple(errors)
