"""A simulator under other parameters: friction, stiffness, time step, masses."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from quasistatic_ref.errors import InputError, check_kind
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.simulate.simulator import Simulator

PARAMETERS: Final = ("mu_v", "mu_omega", "K_q", "h", "masses")
"""What a simulator keeps from step to step, by the names of derivatives."""


def values_of(simulator: Simulator) -> dict[str, Array]:
    """The parameters of a simulator by their names, each of shape (P,) [of the parameter]."""
    return {
        "mu_v": np.array([pair.mu_v for pair in simulator.pairs], np.float64),
        "mu_omega": np.array([pair.mu_omega for pair in simulator.pairs], np.float64),
        "K_q": np.diag(simulator.K_q),
        "h": np.array([simulator.h]),
        "masses": simulator.system.masses,
    }


def with_parameters(simulator: Simulator, values: Mapping[str, Array]) -> Simulator:
    """A new simulator in which some parameters are others; K_q keeps what is off its diagonal.

    Inertias about the links' centres of mass stay.

    Parameters
    ----------
    simulator : Simulator
        Of a System.
    values : mapping of str to ndarray, shape (P,)
        As of :func:`values_of` [of the parameter].

    Raises
    ------
    InputError
        If a value is one that no simulator takes.
    """
    now = values_of(simulator) | dict(values)
    system = simulator.system
    assert isinstance(system, System)
    if "masses" in values and not np.array_equal(now["masses"], system.masses):
        system = with_masses(system, now["masses"])
    K_q = simulator.K_q.copy()
    np.fill_diagonal(K_q, now["K_q"])
    friction = zip(simulator.pairs, now["mu_v"].tolist(), now["mu_omega"].tolist(), strict=True)
    changed = {
        "system": system,
        "pairs": [replace(pair, mu_v=mu_v, mu_omega=mu_omega) for pair, mu_v, mu_omega in friction],
        "K_q": K_q,
        "h": now["h"].item(),
        "backend": simulator.named_backend,
    }
    return type(simulator)(**simulator.settings() | changed)


def with_masses(system: System, masses: Array) -> System:
    """The system with other masses of the links, (L,) [kg]; the world has none.

    Raises
    ------
    InputError
        If one is negative, or the world has one; or as a System that is made of them.
    """
    world, *each = masses.tolist()
    if world or min(each, default=0.0) < 0:
        raise InputError("must be 0 of the world, and not negative", field="masses", value=masses)
    bodies, trees = system.__getstate__()
    left = iter(each)
    changed = [
        replace(tree, links={k: replace(v, mass=next(left)) for k, v in tree.links.items()})
        for tree in trees
    ]
    other = System.__new__(System)
    other.__setstate__((bodies, tuple(changed)))
    return other


def checked_names(names: str | Iterable[str]) -> tuple[str, ...]:
    """Names of parameters; InputError if one is none, or is there twice."""
    check_kind(names, Iterable, "by", f"some of {', '.join(PARAMETERS)}")
    every = (names,) if isinstance(names, str) else tuple(names)
    for name in every:
        if name not in PARAMETERS or every.count(name) > 1:
            problem = f"must be some of {', '.join(PARAMETERS)}, each once"
            raise InputError(problem, field="by", value=every)
    return every
