"""The moving figures of the docs: ``python -m validation.make.moving_figures [--out FOLDER]``.

The grasp with and without torsional friction, side by side, and a block that slides, drawn with
its height above the table times 200.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.animation import PillowWriter
from matplotlib.axes import Axes

from docs.drawings import sliding_block
from quasistatic_ref.lab.cached_runs import grasp
from quasistatic_ref.lab.figures.grasp import HALF, SHOWN
from quasistatic_ref.lab.grasp import CASES, rotations
from quasistatic_ref.optional.show.figures import figure_style
from quasistatic_ref.optional.show.figures.draw import draw_scene, force_scale
from quasistatic_ref.optional.show.figures.moments import moment
from validation.tools.scripts import script_options

FRAMES_PER_SECOND = 8
DOTS_PER_INCH = 70


def film(path: Path, size: tuple[float, float], columns: int, frames: int,
         draw: Callable[[list[Axes], int], None]) -> None:  # fmt: skip
    """Write a GIF of axes in a row, which ``draw(axes, frame)`` fills."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with figure_style(), plt.rc_context({"savefig.bbox": None}):
        page, row = plt.subplots(1, columns, figsize=size, layout="constrained", squeeze=False)
        writer = PillowWriter(fps=FRAMES_PER_SECOND)
        with writer.saving(page, str(path), DOTS_PER_INCH):
            for frame in range(frames):
                for axes in row[0]:
                    axes.clear()
                draw(list(row[0]), frame)
                writer.grab_frame()
        plt.close(page)


def grasps(path: Path) -> None:
    """Both runs of the grasp, each tenth step."""
    scenario = grasp("with torsion")[0]
    runs = {case: grasp(case)[1] for case in CASES}
    turned = rotations(scenario, runs)
    steps = range(0, len(runs["with torsion"]["t"]), 10)
    moments = {case: [moment(scenario, run, k) for k in steps] for case, run in runs.items()}
    scale = force_scale([one for of in moments.values() for one in of], SHOWN["view"], HALF)

    def draw(row: list[Axes], frame: int) -> None:
        for axes, (case, of) in zip(row, moments.items(), strict=True):
            draw_scene(axes, of[frame], **SHOWN, metres_per_newton=scale)
            angle = np.interp(of[frame].t, turned["times"], turned["angles"][case], left=0.0)
            axes.set_title(f"{case}: turned by {angle:.0f} degrees")

    film(path, (6.4, 3.6), len(runs), len(steps), draw)


def main() -> None:
    """Write both."""
    out = script_options(__doc__, out=Path("moving_figures")).out
    grasps(out / "grasp.gif")
    steps = range(0, sum(sliding_block.STEPS) + 1, 2)
    film(out / "sliding_block.gif", (4.6, 2.6), 1, len(steps),
         lambda row, frame: sliding_block.drawn(row[0], steps[frame]))  # fmt: skip


if __name__ == "__main__":
    main()
