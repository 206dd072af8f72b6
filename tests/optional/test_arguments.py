"""An argument of another kind is refused in one sentence that begins with its name."""

import inspect
import re
from functools import partial
from operator import attrgetter

import numpy as np
import pytest

import quasistatic_ref as qr
from tests.errors.test_python_mistakes import (
    BLOCK,
    FLOOR,
    FORM,
    Q_A,
    RUN,
    SCENARIO,
    SIMULATOR,
    STEP,
    SYSTEM,
    Q,
)

SOLUTION = qr.solve_step(STEP)
GOOD = {
    "System": ([BLOCK],),
    "Body": ("b", "b.urdf"),
    "ContactPair": ("f", FLOOR, SYSTEM.shapes[1], 0.3, 0.0),
    "Limits": (),
    "Sphere": (0.1,),
    "Box": ((0.1, 0.1, 0.1),),
    "Capsule": (0.1, 0.2),
    "Cylinder": (0.1, 0.2),
    "Cone": (0.1, 0.2),
    "Ellipsoid": ((0.1, 0.1, 0.1),),
    "HalfSpace": ((0, 0, 1), 0.0),
    "PointCloud": (np.eye(3),),
    "Recorder": (SIMULATOR, Q),
    "Simulator": (SYSTEM, []),
    "StepProblem": (STEP,),
    "animate": (SCENARIO, RUN, "x.gif"),
    "contact_forces": (STEP,),
    "convex_hull": (np.eye(4, 3),),
    "coulomb_step": (STEP,),
    "derivatives": (SIMULATOR, Q, Q_A),
    "load_answer": ("x.json",),
    "load_qp": ("x.npz",),
    "load_scenario": ("sphere_spin",),
    "load_solution": ("x.json", STEP),
    "load_step": ("x.json",),
    "load_trajectory": ("x.npz",),
    "optimality_residuals": (FORM, np.zeros(12), np.zeros(16)),
    "relative_turn": (SYSTEM, RUN, "block", "finger"),
    "rollout": (SIMULATOR, Q, Q_A, 1),
    "save_solution": ("x.json", SOLUTION),
    "save_step": ("x.json", STEP),
    "save_trajectory": ("x.npz", RUN),
    "save_view": ("x.html", SIMULATOR),
    "scanned_body": ("x.ply",),
    "solve_step": (STEP,),
    "standard_form": (STEP,),
    "step_jax": (SIMULATOR,),
    "verify": (SOLUTION,),
    "Recorder.add": (qr.Recorder(SIMULATOR, Q), Q_A, SIMULATOR.step(Q, Q_A)),
    "Simulator.step": (SIMULATOR, Q, Q_A),
    "StepProblem.fill": (qr.StepProblem(STEP), STEP),
    "StepProblem.solve": (qr.StepProblem(STEP),),
    "System.of": (SYSTEM, Q, "block"),
    "System.placed": (SYSTEM, {}),
    "Trajectory.forces_on": (RUN, "block", SCENARIO),
    "Trajectory.step_data": (RUN, 0),
    "verify_answer": (STEP, np.zeros(12), []),
}
"""Public callables that people call, with good arguments, of methods an object first."""
ELSEWHERE = {
    *("draw_scene", "draw_scenes"),  # tests/optional/show
    *("exact_lp", "exact_ls", "exact_qp"),  # tests/exact/qp
    "register_qpsolvers",  # tests/optional/qp_doors
    *("mujoco_opinion", "mujoco_scenario", "mujoco_step"),  # tests/optional/mujoco
}
OTHERS = {"scanned_body": {"mass": 1.0}, "Simulator": {"h": 0.01, "K_q": 100.0}}
ANY = {
    *("extension", "progress", "findings", "of_others", "hull", "target", "notes", "size"),
    *("self", "additions", "judge", "options", "fields", "name"),
}  # fmt: skip
"""Arguments that may be of many kinds: truths, functions, names."""
CALLED = {
    "to": "link",
    "length": "half_length",
    "q_bar_a": "q_a",
    "scenario": "scene",
    "convex_hull.points": "vertices",
    "Trajectory.step_data.k": "step",
}
"""Arguments that a sentence names in another way."""


def arguments():
    for name, good in GOOD.items():
        for parameter in inspect.signature(attrgetter(name)(qr)).parameters:
            if parameter not in ANY:
                yield pytest.param(name, good, parameter, id=f"{name}-{parameter}")


@pytest.mark.parametrize(("name", "good", "parameter"), [*arguments()])
def test_an_argument_of_another_kind_is_refused_by_its_name(name, good, parameter):
    function = partial(attrgetter(name)(qr), **OTHERS.get(name, {}))
    bound = inspect.signature(function).bind(*good)
    bound.arguments[parameter] = object()
    with pytest.raises(qr.QuasistaticError) as refused:
        function(*bound.args, **bound.kwargs)
    sentence = str(refused.value)
    said = CALLED.get(f"{name}.{parameter}", CALLED.get(parameter, parameter))
    assert re.search(rf"\b{said}: (must|is) ", sentence)
    assert "\n" not in sentence
    assert len(sentence) < 500


def test_every_public_function_is_asked():
    functions = {name for name in qr.__all__ if inspect.isfunction(getattr(qr, name))}
    assert functions <= GOOD.keys() | ELSEWHERE
