"""The observer that warns: it measures the artifacts of each step, and speaks at the end."""

import sys
from dataclasses import replace

import numpy as np

from quasistatic_ref.optional.doctor.artifacts import (
    boundary_layer,
    drag_share,
    gap_after,
    quasi_dynamic_number,
    warning,
)
from quasistatic_ref.optional.doctor.watch import doubtful_units, watched
from quasistatic_ref.simulate.observer import Observer
from quasistatic_ref.simulate.recorder import Recorder
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Array


class Warnings(Observer):
    """Sentences on a run, and the largest of its artifacts, in the header of its trajectory.

    Parameters
    ----------
    printed : bool
        Whether to print the sentences on standard error, too.
    """

    notes = ("gap", "Pi", "drag", "layer")

    def __init__(self, printed: bool) -> None:
        self.printed = printed

    def after(self, recorder: Recorder, result: StepResult) -> dict[str, Array | float | None]:
        """Gaps after the step, shape (n_c,) [m], Pi, share of drag [-] and boundary layer [m]."""
        step, solution = result.step, result.solution
        system, gravity = recorder.system, recorder.gravity
        gap = gap_after(solution, system.n_v)
        return {
            "gap": gap,
            "Pi": quasi_dynamic_number(system, step, solution.delta_q, gravity),
            "drag": drag_share(system, solution, gravity),
            "layer": boundary_layer(gap, solution),
        }

    def end(self, recorder: Recorder, trajectory: Trajectory, interrupted: bool) -> Trajectory:
        """The trajectory with what the run warns of."""
        header = {
            **trajectory.header,
            "quasi_dynamic_number": _largest(recorder.noted("Pi")),
            "largest_drag_share": _largest(recorder.noted("drag")),
            "largest_boundary_layer": _largest(recorder.noted("layer")) or 0.0,
        }
        if trajectory.steps:
            sentences = watched(recorder.scene, trajectory.arrays, recorder.noted("gap"))
        else:  # it failed in its first step, for which a unit may be the reason
            sentences = list(doubtful_units(recorder.scene))
        drags = warning(header)
        header["warnings"] = [*sentences, *([] if drags is None else [drags])]
        if self.printed:
            for sentence in header["warnings"]:
                print(f"quasistatic-ref: {sentence}", file=sys.stderr)
        return replace(trajectory, header=header)


def _largest(values: Array) -> float | None:
    """The largest of some values [any unit], those that are not known left out."""
    known = values[~np.isnan(values)]
    return float(known.max()) if known.size else None
