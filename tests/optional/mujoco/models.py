"""Models of MuJoCo's, their states, and the steps of these."""

from typing import Any, NamedTuple

import mujoco

from quasistatic_ref import StepSolution, mujoco_step, solve_step

H = 0.01
GRAVITY = 9.81


def mjcf(world, rest="", options=""):
    """MJCF text."""
    return f"<mujoco>{options}<worldbody>{world}</worldbody>{rest}</mujoco>"


def model_of(text):
    return mujoco.MjModel.from_xml_string(text)


def posed(text, **values):
    """A model, and its first state, of which some fields have other values."""
    model = model_of(text)
    data = mujoco.MjData(model)
    for name, value in values.items():
        getattr(data, name)[:] = value
    return model, data


class Moved(NamedTuple):
    """By how much each of MuJoCo's coordinates moves in a step, and what the step leaves out."""

    by: Any
    answer: StepSolution
    notes: str


def moved(model, data, depth="closed"):
    """The step of a state."""
    step, coordinates = mujoco_step(model, data, H, depth)
    answer = solve_step(step)
    return Moved(coordinates.T @ answer.delta_q, answer, " ".join(coordinates.left_out))
