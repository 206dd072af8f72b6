"""Derivatives of q+ by central differences of steps without rounding.

Column j of dq+/dq is the limit of [F(q (+) eps e_j) (-) F(q (+) -eps e_j)] / (2 eps), both taken in
the tangent space at F(q). With eps = 2^-100 the quotient is off by eps^2, 6e-61, times a third
derivative, and by 2^-320 / 2^-100 from the grid, 6e-67, times the condition of the program.
"""

from collections.abc import Callable
from dataclasses import dataclass

from flint import fmpq

from quasistatic_ref.lab.program.candidates import smaller
from quasistatic_ref.lab.program.integration import way
from quasistatic_ref.lab.vectors.exact.precision import Vector
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.unrounded.grid import STEP, on_grid, working_precision
from quasistatic_ref.lab.vectors.unrounded.nearby import Near, candidates, kept_candidates, pool
from quasistatic_ref.lab.vectors.unrounded.step import (
    Contact,
    Solved,
    after,
    contact,
    step_solution,
)
from quasistatic_ref.lab.vectors.unrounded.world import World, world


@dataclass(eq=False)
class Base:
    """A step, and what a step nearby has in common with it.

    Parameters
    ----------
    at : World
    contacts : list of Contact
    step : Solved
    q_next : vector
    pools : list of list of int
        Of each pair the candidates that can be kept nearby.
    """

    at: World
    contacts: list[Contact]
    step: Solved
    q_next: Vector
    pools: list[list[int]]

    def contacts_at(self, at: World) -> list[Contact]:
        """The contacts of a case nearby."""
        found = [near for pair in range(len(self.pools)) for near in self._kept_of_pair(at, pair)]
        return [contact(at, near) for near in found]

    def _kept_of_pair(self, at: World, pair: int) -> list[Near]:
        near = candidates(at, pair, self.pools[pair])
        return kept_candidates(near, at.case["pairs"][pair]["k"], least=least_solid(at.case, pair))

    def step_at(self, case: Json) -> tuple[Solved, list[Contact], Vector]:
        """A step nearby: solved, its contacts, and q+ in the tangent space at the base's q+."""
        moved = case["q"] is not self.at.case["q"]  # if not, bodies and contacts stay
        at = world(case) if moved else World(case, self.at.at)
        contacts = self.contacts_at(at) if moved else self.contacts
        found = step_solution(at, contacts, self.step.optimum.minimiser.working)
        return found, contacts, away(at, self.q_next, after(at, found.delta_q))


def least_solid(case: Json, pair: int) -> float | None:
    """Size of the smaller of a pair's two solids [m]; None where a side is a cloud."""
    sides = (case["pairs"][pair][side] for side in ("alpha", "beta"))
    alpha, beta = (case["shapes"][name]["shape"] for name in sides)
    return None if "cloud" in (alpha["kind"], beta["kind"]) else smaller(alpha, beta)


def away(at: World, q_next: Vector, other: Vector) -> Vector:
    """Difference other (-) q_next, on the grid [m, rad]."""
    with working_precision():
        return on_grid(way(at.case["mechanism"], q_next, other))


def base(case: Json) -> Base:
    """The step of a case.

    Parameters
    ----------
    case : dict
        Input of the layer ``step``.
    """
    at = world(case)
    pools = []
    contacts = []
    for pair, written in enumerate(case["pairs"]):
        found = candidates(at, pair)
        least = least_solid(case, pair)
        pools.append(pool(found, written["k"], least=least))
        near = kept_candidates(found, written["k"], least=least)
        contacts += [contact(at, one) for one in near]
    step = step_solution(at, contacts)
    return Base(at, contacts, step, after(at, step.delta_q), pools)


@dataclass(frozen=True, eq=False)
class Quotient:
    """A central difference.

    Parameters
    ----------
    column : vector
        First difference over 2 eps.
    bend : fmpq
        Largest entry of the second difference over eps: of the order of eps where q+ is smooth, of
        the jump of the derivative where it is not.
    sides : tuple of (Solved, list of Contact)
        What the two steps were.
    """

    column: Vector
    bend: fmpq
    sides: tuple[tuple[Solved, list[Contact]], ...]


def quotient(one: Base, inputs: Callable[[fmpq], Json], eps: fmpq = STEP) -> Quotient:
    """Derivative of q+ along a curve of inputs.

    Parameters
    ----------
    one : Base
        Its step is that at 0.
    inputs : callable
        From a number to a case.
    eps : fmpq
    """
    forward, ahead, up = one.step_at(inputs(eps))
    backward, behind, down = one.step_at(inputs(-eps))
    bend = max(abs(up + down) / eps, default=fmpq(0))
    sides = ((forward, ahead), (backward, behind))
    return Quotient((up - down) / (2 * eps), bend, sides)
