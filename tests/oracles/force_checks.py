"""Contact forces by compliance: one answer, whatever should not matter.

On a step (random and degenerate: duplicated contacts, penetration, coefficients of 0, masses 1e9
apart; one polyhedral cone after the other):

- every backend and none, plain and fast, cold, and contacts in another order give equal bits;
- so does the definition, in which what each contact gives way by is solved for, too;
- so do fractions, by which the optimum is proved (tests/oracles/compliant_forces.py; the pyramid);
- noise of 1e-17 in phi changes forces by no more than the bound of (R42).

On piles of boxes, with masses of 1 g to 1000 t, h of 0.1 to 100 ms, 1 to 20 bodies up to 1000
times as heavy as each other, half of them under a spring of 1e2 to 1e9 N/m, in metres, millimetres
and kilometres, the formula of the scene says what each level of contacts bears:

- forces bear it to 1e-6 of the largest, and imbalance is as small;
- the four corners of a level bear equal forces, to the last bit;
- a last bit of noise in phi changes them as (R42) says: by at most 1e-3 of the load of the group
  where that bound is below 1e-3;
- every backend and both speeds give equal bits;
- the same scene in another unit of length has the same forces, to 1e-6 or the bound.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from quasistatic_ref import (
    QuasistaticError,
    StepData,
    StepSolution,
    contact_forces,
    solve_step,
)
from quasistatic_ref.certify.exact import step_optimum
from quasistatic_ref.lab.scenes.contacts import repeated
from quasistatic_ref.lab.scenes.loads import loaded_pile
from quasistatic_ref.optional.forces.forces import WRENCH, defined_optimum
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.step.groups import groups
from quasistatic_ref.tolerances import SURE
from tests.oracles.compliant_forces import forces as independent_forces
from tests.oracles.random_steps import mixed_step

BACKENDS = ("clarabel", "osqp", "piqp", "daqp", "scs", "none")
CONES = (PYRAMID, "product", "facets-6", "frictionless")
LOADS = ("load", "imbalance", "equal", "noise", "bits", "units")
NOISE = 2.0**-56
"""A last bit of lengths of 0.1 m [m]."""
LOST = 1e-6
UNITS = (1.0, 1e-3, 1e3)
"""[m]"""
FEW = 12
"""Bodies up to which all backends are asked; with more they take minutes."""
Record = dict[str, Any]


def differences(step: StepData, oracle: bool) -> Record:
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
        "fast": solve_step(step, "daqp", fast=True).forces.tobytes() == bits,
        "cold": contact_forces(step).wrench.tobytes() == bits,
        "permuted": moved.tobytes() == forces[order].tobytes(),
    }
    if len(set(c.tolist())) == 1:
        held["definition"] = defined_optimum(step, c[0])[0][:, WRENCH].tobytes() == bits
        if oracle and step.cone == PYRAMID and not step.extra.names:
            held["independent"] = independent_forces(step, c[0]).tobytes() == bits
    noise, bound = noise_of_rounding(step, first)
    held["noise"] = noise <= bound
    return {name: int(not holds) for name, holds in held.items()}


def noise_of_rounding(step: StepData, clean: StepSolution) -> tuple[float, float]:
    """The largest change of a force by noise in phi, over the forces of its group, and its bound.

    A contact that moves with nothing may contradict the noise; it gives way all the same.
    """
    rng = np.random.default_rng(1)
    k = step.contacts
    phi = k.phi + NOISE * rng.choice([-1.0, 0.0, 1.0], k.n_c)
    moved = step.replace(contacts=repeated(k, range(k.n_c), phi=phi))
    near = clean.delta_q, clean.wrench
    noisy = contact_forces(moved, clean.compliant.compliance, near).wrench
    changes = np.abs(noisy - clean.forces) / k.mu.max(initial=1.0)
    largest = bound = 0.0
    for group in groups(step):
        own = group.contacts
        load = clean.forces[own, 2].sum()
        if load:
            largest = max(largest, changes[own].max() / load)
            c = clean.compliant.compliance[own][0]
            bound = max(bound, np.linalg.norm(phi[own] - k.phi[own]) / c / load)
    return largest, bound + ROUNDED


ROUNDED = 1e-15
"""Of forces, whose numbers are rounded [-]."""


def loads(seed: int) -> Record:
    """Of each check on a pile at random 1 if it fails and 0 if it holds."""
    rng = np.random.default_rng([seed, 59])
    count = 1 if seed % 3 == 0 else int(rng.integers(2, 21 if seed % 20 == 1 else 8))
    ratios = 10.0 ** np.array(
        [rng.uniform(0, 3, count), np.linspace(0, 3, count), np.linspace(3, 0, count)][seed % 3 - 1]
    )
    masses = 10.0 ** rng.uniform(-3, 6) * ratios / ratios.max()
    args = {"h": 10.0 ** rng.uniform(-4, -1)}
    if seed % 2:
        args |= {"spring": 10.0 ** rng.uniform(2, 9), "press": 10.0 ** rng.uniform(-1, 4)}
    scene = loaded_pile(masses.tolist(), **args)
    step = scene.step
    first = solve_step(step, "none")
    levels = first.forces[:, 2].reshape(-1, 4)
    off = np.abs(levels.sum(axis=1) - scene.borne).max() / scene.borne.max()
    noise, bound = noise_of_rounding(step, first)
    unit = UNITS[seed % 7 % 3]
    scaled = contact_forces(loaded_pile(masses.tolist(), **args, unit=unit).step)
    apart = np.abs(scaled.wrench[:, 2] * unit - first.forces[:, 2]).max() / levels.sum()
    held = {
        "load": off < LOST,
        "imbalance": 0 < first.imbalance < LOST,
        "equal": bool((levels == levels[:, :1]).all()),
        "noise": noise <= bound,
        "units": apart < LOST + first.compliant.sensitivity * NOISE,
    }
    if count <= FEW:
        found = [solve_step(step, name, fast=fast).forces for name, fast in ASKED]
        held["bits"] = {forces.tobytes() for forces in found} == {first.forces.tobytes()}
    return {name: int(not holds) for name, holds in held.items()} | {"sure": int(bound < SURE)}


ASKED = (("clarabel", False), ("osqp", False), ("daqp", True))
"""Backends of the piles, and whether they are fast."""


def random_steps(count: int) -> Iterator[tuple[str, StepData]]:
    """The first random steps that have a solution."""
    seed = found = 0
    while found < count:
        step = mixed_step(seed).replace(cone=CONES[seed % len(CONES)])
        seed += 1
        try:
            step_optimum(step)
        except QuasistaticError:
            continue
        found += 1
        yield f"random {seed - 1}", step
