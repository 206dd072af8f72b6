"""The derivatives of a step: of the map q+ = F(q, q_bar_a, tau, parameters).

In tangent coordinates on both sides: column j of dq_dq is the derivative at eps = 0 of
F(q (+) eps e_j) (-) F(q). The formula is exact, and evaluated in float64 from the exact optimum and
its working set. docs/derivatives.md says what the numbers mean, how right they are, and where
there are none.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import InputError
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, checked_numbers
from quasistatic_ref.optional.derivatives.gradient import (
    Derivatives,
    combined,
    directed,
    gradient,
)
from quasistatic_ref.optional.derivatives.kink_reasons import geometry_obstacles, out_of_reach
from quasistatic_ref.optional.derivatives.program_reasons import row_obstacles, target_obstacles
from quasistatic_ref.optional.derivatives.step.nearly import nearly_weak
from quasistatic_ref.optional.derivatives.step.optimum_rates import Equations
from quasistatic_ref.optional.derivatives.step.touching import touching_rows
from quasistatic_ref.optional.derivatives.step_rates import StepRates
from quasistatic_ref.optional.derivatives.tolerances import NEARLY
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.cones import cone

__all__ = ["Derivatives", "derivatives"]


def derivatives(
    simulator: Simulator,
    q: ArrayLike,
    q_bar_a: ArrayLike,
    force: ArrayLike | None = 0.0,
    towards: Mapping[str, ArrayLike] | None = None,
    nearly: float = NEARLY,
) -> Derivatives:
    """The derivatives of the step that a simulator would take.

    Parameters
    ----------
    simulator : Simulator
        Of a polyhedral cone, without an extension.
    q : array_like, shape (n_q,)
    q_bar_a : array_like, shape (n_q_a,)
    force : array_like, shape (n_v,), optional
        External generalised force in addition to gravity, which does not depend on q [N, N m].
    towards : mapping, optional
        A direction of the parameters, with names, shapes (n_v,), (n_a,), ... and units
        [of the parameter] as in ``Derivatives.along``. Where rows touch without load, the
        derivatives are then those next to the kink, on the side to which it points.
    nearly : float
        Distance to a kink, in natural units [-], below which the state counts as at it: rows that
        nearly touch, or nearly bear no load, are then as rows that touch without load.

    Returns
    -------
    Derivatives

    Raises
    ------
    InputError
        If the cone is no polyhedron, the simulator has an extension, a name or a shape of the
        direction is wrong, or `nearly` or the direction is not finite.
    StepNotSolved
        As :meth:`~quasistatic_ref.simulate.simulator.Simulator.step` does.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin")
    >>> simulator, q = scenario.simulator(), scenario.system.q_start
    >>> rates = qr.derivatives(simulator, q, [])
    >>> rates.differentiable
    True
    """
    check_derivable(simulator)
    check_nearly(nearly)
    q = np.asarray(q, dtype=np.float64)
    result = _certified(simulator, q, q_bar_a, force)
    rates = StepRates(simulator, q, result)
    equations = Equations(touching_rows(result.solution, rates.far))
    near = nearly_weak(equations, equations.rates(rates.data), rates.data, nearly * rates.units)
    if len(near):
        equations = Equations(equations.of.unloaded(near))
    if towards is not None:
        one = combined(rates.data, directed(rates.places, towards, "towards"))
        equations = Equations(equations.beyond(one))
    touching = equations.of
    x_rates = equations.rates(rates.data)
    obstacles = [
        *geometry_obstacles(simulator, rates, touching, out_of_reach(simulator, rates)),
        *target_obstacles(simulator, rates),
        *row_obstacles(simulator, rates, touching, x_rates, {*map(tuple, near)}),
    ]
    return gradient(rates, x_rates.x, obstacles, equations.along)


def check_nearly(nearly: float) -> None:
    """Refuse a `nearly` that is no distance [-]: InputError."""
    number = checked_numbers(nearly, "nearly", InputError)
    if number.shape or not 0 <= number < np.inf:
        raise InputError("must be a finite distance, 0 or more", field="nearly", value=nearly)


def check_derivable(simulator: Simulator) -> None:
    """Refuse what has no derivatives.

    Raises
    ------
    InputError
        If the cone is no polyhedron, the law not convex, the simulator has an extension, or its
        scene is MuJoCo's.
    """
    if not isinstance(simulator.system, System):
        problem = "has no derivatives where MuJoCo moves it; write its bodies as URDFs"
        raise InputError(problem, field="system", value=type(simulator.system).__name__)
    if not cone(simulator.cone).polyhedral:
        raise InputError("must be a polyhedron for derivatives", field="cone", value=simulator.cone)
    if simulator.law != CONVEX:
        problem = f'must be "{CONVEX}" for derivatives, which are those of one convex step'
        raise InputError(problem, field="law", value=simulator.law)
    if simulator.extension is not None:
        # A scenario's extension names the fields of bodies that it is made of.
        field = getattr(simulator.extension, "fields", ("extension",))[0]
        why = "its rows may be any function of q"
        if field != "extension":
            why = "derivatives are of contacts alone; leave it out of the tables of bodies"
        raise InputError(f"has no derivative: {why}", field=field)


def _certified(
    simulator: Simulator, q: Array, q_bar_a: ArrayLike, force: ArrayLike | None
) -> StepResult:
    """The step with its exact optimum, whatever the simulator certifies."""
    result = simulator.step(q, q_bar_a, force)
    if result.solution.certificate.kind == "exact":
        return result
    solution = solve_step(result.step.replace(), "none")
    q_next = simulator.system.integrate(q, solution.delta_q)
    return replace(result, q=q_next, step=solution.step, solution=solution)
