"""Derivatives of a step by differences of steps without rounding, along any direction.

Nothing here knows the package's formulas for derivatives: steps at both sides of a configuration
are computed from the mechanism to q+, and subtracted.
"""

from collections.abc import Callable
from typing import Final

import numpy as np
from flint import fmpq

from quasistatic_ref.lab.vectors.distances.witness import Witness
from quasistatic_ref.lab.vectors.exact.algebra import Vector, scaled
from quasistatic_ref.lab.vectors.exact.precision import numbers
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.whole import along
from quasistatic_ref.lab.vectors.whole.differences import Base, Quotient, are_solids, quotient
from quasistatic_ref.lab.vectors.whole.nearby import Near, kept, pool, tied
from quasistatic_ref.lab.vectors.whole.reasons import BEND
from quasistatic_ref.lab.vectors.whole.step import after, contact, solved
from quasistatic_ref.lab.vectors.whole.world import World, world
from quasistatic_ref.step.data import Array
from tests.oracles.gradients.contacts import nearby
from tests.oracles.gradients.states import State

FIELDS: Final = {
    "dq_dq": "q",
    "dq_dq_bar_a": "q_bar_a",
    "dq_dtau": "tau",
    "dq_dmu_v": "mu_v",
    "dq_dmu_omega": "mu_omega",
    "dq_dK_q": "K_q",
    "dq_dh": "h",
    "dq_dmasses": "m",
}
Inputs = Callable[[fmpq], Json]


class Reference(Base):
    """A step whose pairs of solids may be any, apart or in penetration."""

    starts: list[Witness | None]

    def _kept(self, at: World, pair: int) -> list[Near]:
        found = nearby(at, pair, self.starts[pair], self.pools[pair])
        return kept(found, at.case["pairs"][pair]["k"], solids=are_solids(at.case, pair))


def reference(state: State) -> Reference:
    """The step of a state.

    Raises
    ------
    InputError
        If the step has no solution.
    ArithmeticError
        If its closest points do not follow float64's.
    """
    at = world(state.case)
    pools, contacts = [], []
    for pair, written in enumerate(state.case["pairs"]):
        found, solids = nearby(at, pair, state.starts[pair]), are_solids(state.case, pair)
        pools.append(pool(found, written["k"], solids=solids))
        contacts += [contact(at, one) for one in kept(found, written["k"], solids=solids)]
    step = solved(at, contacts)
    one = Reference(at, contacts, step, after(at, step.delta_q), pools)
    one.warm, one.starts = list(step.optimum.point.working), state.starts
    return one


def moved(one: Reference, name: str, way: Vector) -> Inputs:
    """The case along a direction of a parameter, as a function of how far.

    Parameters
    ----------
    one : Reference
    name : str
        A value of FIELDS.
    way : vector
        As many numbers as the parameter has: one for each pair, body with a mass, ...
    """
    tree, case = one.at.tree, one.at.case
    massive = [k for k, body in enumerate(case["mechanism"]["bodies"]) if "mass" in body]

    def inputs(by: fmpq) -> Json:
        match name:
            case "q":
                return along.with_q(tree, way, case, by)
            case "q_bar_a":
                return along.with_target(tree, way, case, by)
            case "tau":
                return along.with_force(way, case, by)
            case "h":
                return along.with_time(case, way[0] * by)
        found = case
        for k, change in enumerate(scaled(way, by)):
            if not change:
                continue
            if name == "K_q":
                found = along.with_stiffness(k, found, change)
            elif name == "m":
                found = along.with_mass(massive[k], found, change)
            else:
                found = along.with_friction(name, k, found, change)
        return found

    return inputs


def slope(one: Reference, field: str, direction: Array) -> tuple[Array, bool]:
    """Derivative of q+ along a direction, in float64; and whether it is one, not a kink.

    Parameters
    ----------
    one : Reference
    field : str
        A key of FIELDS.
    direction : ndarray, shape (P,)
        Exact in float64, in the case's order.
    """
    name = FIELDS[field]
    found = quotient(one, moved(one, name, numbers(direction.tolist())), moved=name == "q")
    return column(found), bool(found.bend < BEND)


def column(found: Quotient) -> Array:
    """The quotient in float64, shape (n_v,) [per unit of the parameter]."""
    return np.array([int(x.p) / int(x.q) for x in found.column])


def tied_pairs(one: Reference) -> bool:
    """Whether candidates of some pair that are kept and left out are equally near."""
    for pair, written in enumerate(one.at.case["pairs"]):
        found = nearby(one.at, pair, one.starts[pair], one.pools[pair])
        if tied(found, written["k"], solids=are_solids(one.at.case, pair)):
            return True
    return False
