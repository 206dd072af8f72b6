"""Every example by name, in the order in which they are best read."""

from importlib import import_module
from typing import Any

from quasistatic_ref.optional.show.figures import Figure, figure_style

EXAMPLES = {
    "block_on_a_table": "one_step",
    "cone_surfaces": "friction",
    "finger_spring_block": "one_step",
    "the_step_loop": "one_step",
    "phi_and_j_of_a_cloud": "geometry",
    "two_moving_bodies": "geometry",
    "mass_of_a_free_body": "geometry",
    "a_screw": "geometry",
    "drag_against_h": "friction",
    "both_laws": "friction",
    "flat_patch": "friction",
    "which_cone_is_real": "friction",
    "boundary_layer": "friction",
    "pinch_threshold": "grasps",
    "hold_or_slip": "grasps",
    "grasp": "grasps",
    "grasp_against_mu_omega": "grasps",
    "clouds_of_a_grasp": "grasps",
    "margin_of_a_grip": "grasps",
    "gradient_of_a_push": "gradients",
    "where_no_gradient_is": "gradients",
    "what_smoothing_does": "gradients",
    "plan_a_push": "gradients",
    "solver_digits": "one_step",
    "metres": "one_step",
    "door": "mechanisms",
    "peg_in_a_hole": "mechanisms",
    "robot_push": "mechanisms",
    "hand_turns_a_drum": "mechanisms",
}
"""Its folder, by the name of each."""


def example(name: str) -> Any:
    """The module of an example."""
    return import_module(f"quasistatic_ref.lab.examples.{EXAMPLES[name]}.{name}")


def figure_of(name: str, ax: Any = None, **parameters: Any) -> Figure:
    """The figure of an example, in the style of the enclosing block, or of paper.

    Parameters
    ----------
    name : str
    ax : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    parameters
        Those of the example's ``figure``.
    """
    with figure_style():
        figure: Figure = example(name).figure(ax, **parameters)
    return figure
