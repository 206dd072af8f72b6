"""Every figure that can be made by name: it runs what it shows, then draws it."""

from __future__ import annotations

from collections.abc import Callable

from matplotlib.figure import Figure

from quasistatic_ref.figures.boundary_layer import boundary_layer
from quasistatic_ref.figures.cones import limit_surfaces, pinch_thresholds
from quasistatic_ref.figures.grasp import grasp_strip, rotation_plot
from quasistatic_ref.simulate.grasp import CASES, CLOSED, TOP
from quasistatic_ref.simulate.scenario import load_scenario
from quasistatic_ref.simulate.trajectory import Trajectory

INSTANTS = (0.3, CLOSED, 1.4, 2.1, TOP)
"""Columns of Figure 1 [s]."""


def bunny_grasp() -> Figure:
    """Figure 1 of the paper: the bunny grasped with and without torsional friction."""
    return grasp_strip(load_scenario("bunny_grasp"), _grasps(), INSTANTS)


def bunny_grasp_rotation() -> Figure:
    """How far the bunny of Figure 1 has turned since the grip closed."""
    return rotation_plot(load_scenario("bunny_grasp"), _grasps(), "bunny", CLOSED)


def sphere_spin() -> Figure:
    """Figure 3 of the paper: the boundary layer of a sphere spun on the floor."""
    scenario = load_scenario("sphere_spin")
    return boundary_layer(scenario, scenario.run(), height_at_rest=0.05)


FIGURES: dict[str, Callable[[], Figure]] = {
    figure.__name__: figure
    for figure in (
        bunny_grasp,
        bunny_grasp_rotation,
        sphere_spin,
        limit_surfaces,
        pinch_thresholds,
    )
}


def _grasps() -> dict[str, Trajectory]:
    return {case: load_scenario("bunny_grasp", own).run() for case, own in CASES.items()}
