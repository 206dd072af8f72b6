"""One thing of every kind of public data, by name."""

import numpy as np
import pytest

from quasistatic_ref import (
    Box,
    Extra,
    HalfSpace,
    InputError,
    LimitExceeded,
    NoFixedPoint,
    NotDifferentiable,
    PointCloud,
    RunFailed,
    Sphere,
    StepDataError,
    StepInfeasible,
    StepNotSolved,
    coulomb_step,
    derivatives,
    load_scenario,
    rollout,
    solve_step,
)
from quasistatic_ref.optional.derivatives.reason import Reason
from tests.helpers import EAST, WEST, point_between_walls, random_step
from tests.scenes import written_scenario

NAN = np.nan


def contradiction_error():
    """The error about a step whose two contacts contradict each other."""
    with pytest.raises(StepInfeasible) as caught:
        solve_step(point_between_walls([EAST, WEST], -1e-3), "none")
    return caught.value


def public_data(folder):
    """Every kind of public data, by name; a scenario is written into a folder."""
    scenario = load_scenario(written_scenario(folder), fast=True)
    grasp = load_scenario("bunny_grasp", ["steps=2"], fast=True)
    system = scenario.system
    simulator = scenario.simulator()
    result = simulator.step(system.q_start, scenario.targets(scenario.h))
    run = rollout(simulator, system.q_start, scenario.targets, 3)
    step = random_step(0)
    extra = Extra(("a", "b"), np.ones((2, 7)), [-1.0, -2.0])
    solution = solve_step(step)
    infeasible = contradiction_error()
    return {
        "StepData": step,
        "StepData with rows of a user's": step.replace(extra=extra),
        "Contacts": step.contacts,
        "posed StepData": result.step,
        "Extra": extra,
        "StepSolution": solution,
        "CoulombSolution": coulomb_step(step),
        "Certificate": solution.certificate,
        "StepResult": result,
        "Derivatives": derivatives(simulator, system.q_start, scenario.targets(scenario.h)),
        "Trajectory": run,
        "System": system,
        "System of the grasp": grasp.system,
        "Body": system.bodies[0],
        "ContactPair": grasp.pairs[0],
        "Scenario": scenario,
        "Scenario of the grasp": grasp,
        "Targets": scenario.targets,
        "Limits": scenario.limits,
        "Wrenches": scenario.wrenches,
        "Sphere": Sphere(0.1),
        "Box": Box([0.1, 0.2, 0.3]),
        # Its normal is divided by its length when it is made; a second time would change bits.
        "HalfSpace": HalfSpace([1.0, 2.0, 3.0], 0.1),
        "PointCloud": PointCloud(np.eye(3)),
        "FarkasVector": infeasible.farkas,
        "InputError": InputError("is bad", field="h", value=np.arange(3.0), file="step.json"),
        "StepDataError": StepDataError("is bad", field="h", value=NAN),
        "StepNotSolved": StepNotSolved("osqp", "user_limit", step, 1e-9),
        "StepInfeasible": infeasible,
        "LimitExceeded": LimitExceeded("is too deep", step),
        "NoFixedPoint": NoFixedPoint(step, 200, 1e-6),
        "NotDifferentiable": NotDifferentiable((Reason(("dq_dq",), (), ("c/0",), "c/0"),)),
        "RunFailed": RunFailed("step 3: is too deep", run, step),
    }
