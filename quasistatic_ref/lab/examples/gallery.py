"""Every example by name, in the order in which they are best read."""

from importlib import import_module
from typing import Any

from quasistatic_ref.optional.show.figures import Figure, figure_style

EXAMPLES = (
    "block_on_a_table",
    "six_rows_of_a_contact",
    "cone_surfaces",
    "finger_spring_block",
    "the_step_loop",
    "phi_and_j_of_a_cloud",
    "two_moving_bodies",
    "mass_of_a_free_body",
    "a_screw",
    "slip_margins",
    "drag_against_h",
    "both_laws",
    "planar_pushing",
    "flat_patch",
    "which_cone_is_real",
    "boundary_layer",
    "pinch_threshold",
    "hold_or_slip",
    "grasp",
    "grasp_against_mu_omega",
    "clouds_of_a_grasp",
    "margin_of_a_grip",
    "gradient_of_a_push",
    "where_no_gradient_is",
    "what_smoothing_does",
    "plan_a_push",
    "solver_digits",
    "door",
    "peg_in_a_hole",
    "robot_push",
    "hand_turns_a_drum",
)


def example(name: str) -> Any:
    """The module of an example."""
    return import_module(f"quasistatic_ref.lab.examples.{name}")


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
