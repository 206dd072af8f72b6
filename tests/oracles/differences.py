"""Derivatives of steps by differences of exact steps: Richardson's combination of central ones."""

import numpy as np


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
