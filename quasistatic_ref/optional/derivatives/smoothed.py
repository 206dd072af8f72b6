"""The smoothed step as a differentiable map: contacts push from afar, and none lets go."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.certify.certificate import Certificate
from quasistatic_ref.certify.solution import SolverStatistics, StepSolution
from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import checked_numbers
from quasistatic_ref.optional.derivatives.derivatives import check_derivable
from quasistatic_ref.optional.derivatives.gradient import Derivatives, gradient
from quasistatic_ref.optional.derivatives.kink_reasons import geometry_obstacles
from quasistatic_ref.optional.derivatives.program_reasons import target_obstacles
from quasistatic_ref.optional.derivatives.step.barrier import barrier_rates, barrier_step
from quasistatic_ref.optional.derivatives.step_rates import StepRates
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.tolerances import FILLED


def check_kappa(kappa: float) -> None:
    """Refuse a `kappa` that is no weight of barriers [N m s]: InputError."""
    number = checked_numbers(kappa, "kappa", InputError)
    if number.shape or not 0 < number < np.inf:
        raise InputError("must be a finite number greater than 0", field="kappa", value=kappa)


def smoothed(
    simulator: Simulator,
    q: ArrayLike,
    q_bar_a: ArrayLike,
    kappa: float,
    force: ArrayLike | None = 0.0,
) -> Derivatives:
    """The step with barriers in place of rows, and its derivatives.

    They tend to those of the exact step as kappa tends to zero, where these exist. What of the
    geometry has kinks has them still.

    Parameters
    ----------
    simulator : Simulator
        Of a polyhedral cone, without an extension.
    q : ndarray, shape (n_q,)
    q_bar_a : ndarray, shape (n_q_a,)
    kappa : float
        Weight of the barriers, > 0 [N m s]: a contact at the distance s pushes with the impulse
        kappa / s. The bias of the derivatives is proportional to it, and a scene's own: where a
        hundredth of it changes them, it is too large. The scenes that come along need 1e-12.
    force : ndarray, shape (n_v,), optional
        External generalised force in addition to gravity, which does not depend on q [N, N m].

    Returns
    -------
    Derivatives
        Its ``result`` is the smoothed step, with nothing claimed about it.

    Raises
    ------
    InputError
        If kappa is no positive finite number, so small that nothing is known, or so large that
        bodies are pushed out of range; if the cone is no polyhedron, or the simulator has an
        extension.
    StepNotSolved
        If nothing lies strictly inside of all rows.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin")
    >>> simulator, q = scenario.simulator(), scenario.system.q_start
    >>> qr.smoothed(simulator, q, [], kappa=1e-6).dq_dtau.shape
    (6, 6)
    """
    check_derivable(simulator)
    check_kappa(kappa)
    q = np.asarray(q, dtype=np.float64)
    kinematics = simulator.system.kinematics(q)
    points = simulator.closest_points(kinematics)
    step = simulator.step_data(q, q_bar_a, force, points)
    barrier = barrier_step(step, kappa)
    if not np.abs(barrier.x).max(initial=0.0) < FILLED:
        raise InputError(
            "is so large that it pushes bodies out of range", field="kappa", value=kappa
        )
    statistics = SolverStatistics("barrier", "solved", None, None, kappa, interface="none")
    solution = StepSolution(
        barrier.x, barrier.lam, step, Certificate("none"), statistics, alone=False
    )
    q_next = simulator.system.integrate(q, barrier.x)
    result = StepResult(q_next, step, solution, points, {})
    rates = StepRates(simulator, q, result)

    nowhere = np.zeros(step.contacts.n_c, dtype=bool)
    obstacles = [
        *geometry_obstacles(simulator, rates, None, nowhere),
        *target_obstacles(simulator, rates),
    ]
    x = barrier_rates(step, barrier, rates.data)
    along = partial(barrier_rates, step, barrier)
    return gradient(rates, x, obstacles, along)
