"""The still figures of pages: ``python -m validation.make.page_figures``.

Those of docs/reality.md come from its results. The others are drawn by their modules in
docs/drawings/, and committed, so that pages show them on a code host, too. ``--style slides``
draws them with larger text: those of docs/slides/figures.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from docs.drawings import (
    both_laws,
    cone_and_dual,
    cone_surfaces,
    contact_geometry,
    corner_loads,
    coulombs_law,
    finger_and_block,
    free_body,
    friction_and_slip,
    grasp_map,
    limit_surface_and_twist,
    many_bodies,
    mass_of_a_free_body,
    metres,
    opinion,
    phi_and_j_of_a_cloud,
    pulled_disk,
    sliding_block,
    slow_step,
    the_program,
    tipping_block,
    turn_and_step,
    two_moving_bodies,
    wedged_peg,
    where_no_gradient_is,
    which_cone_is_real,
    with_and_without_sigma,
    wrenches_of_a_grip,
)
from quasistatic_ref.lab.figures.labels import label_axes, legend_below
from quasistatic_ref.optional.show.figures.style import figure_style, figure_written, panels, scaled
from validation.tools.scripts import RESULTS, script_options

Record = Mapping[str, Any]
DRAWN = (
    both_laws, cone_and_dual, cone_surfaces, contact_geometry, corner_loads,
    coulombs_law, finger_and_block, free_body, friction_and_slip, grasp_map,
    limit_surface_and_twist, many_bodies, mass_of_a_free_body, metres, opinion,
    phi_and_j_of_a_cloud, pulled_disk, sliding_block, slow_step, the_program, tipping_block,
    turn_and_step, two_moving_bodies, wedged_peg, where_no_gradient_is,
    with_and_without_sigma, wrenches_of_a_grip,
)  # fmt: skip
"""Each is the figure of its name."""


def _name_rows(axes: Axes, names: Sequence[str]) -> None:
    """Names at the left, the first at the top."""
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.grid(False, axis="y")


def _marks(axes: Axes, x: Any, y: Any, mark: str, size: float, label: str) -> None:
    axes.plot(x, y, linestyle="", marker=mark, markersize=scaled(size), color="black",
              markerfacecolor="none", label=label)  # fmt: skip


def _spans(axes: Axes, entries: Sequence[Record], k: int, aside: float, **pen: Any) -> None:
    """Means and their intervals of column k, one entry a line."""
    rows = np.arange(len(entries)) + aside
    low, mean, high = (np.array([e[key][k] for e in entries]) for key in ("low", "mean", "high"))
    axes.errorbar(mean, rows, xerr=[mean - low, high - mean], linestyle="", color="black",
                  markersize=scaled(3.5), elinewidth=scaled(0.8), **pen)  # fmt: skip


def identified_ratios(record: Record) -> Figure:
    """mu_omega / mu_v of each pair: interval, published, uniform pressure."""
    figure, (axes,) = panels(5.2, 4.6)
    rows = np.arange(len(record))
    pairs = list(record.values())
    ratio = 1e3 * np.array([e["ratio"] for e in pairs])
    ends = 1e3 * np.array([[e["low"], e["high"]] for e in pairs]).T
    axes.errorbar(ratio, rows, xerr=np.abs(ends - ratio), fmt="o", color="black",
                  markersize=scaled(3.5), label="identified, 95 %")  # fmt: skip
    _marks(axes, 1e3 * np.array([e["published"] for e in pairs]), rows, "s", 5.5, "published")
    _marks(axes, 1e3 * np.array([e["uniform"] for e in pairs]), rows, "|", 8, "uniform")
    _name_rows(axes, list(record))
    axes.set_xlim(left=0)
    label_axes(axes, r"$\mu_\omega / \mu_v$ [mm]")
    return figure


def errors_by_pair(record: Record) -> Figure:
    """Errors of each pair with intervals: this package, and the published simulator."""
    figure, both = panels(6.3, 4.8, columns=2)
    names = list(record["pairs"])
    entries = [record["pairs"][name] for name in names]
    for k, (axes, unit) in enumerate(zip(both, ("position [mm]", "rotation [deg]"), strict=True)):
        _spans(axes, [e["error"] for e in entries], k, -0.15, marker="o", label="ellipsoid, 95 %")
        _spans(axes, [e["published"] for e in entries], k, 0.15, marker="s", markerfacecolor="none",
               label="published simulator")  # fmt: skip
        shown = ["mean over pairs" if name == "all" else name for name in names]
        _name_rows(axes, [""] * len(shown) if k else shown)
        axes.set_xlim(left=0)
        label_axes(axes, f"mean error of {unit}", key=False)
    legend_below(both, both[0].get_legend_handles_labels()[0])
    return figure


def result(name: str) -> Any:
    """A committed result."""
    return json.loads((RESULTS / f"{name}.json").read_text("utf-8"))


def main() -> None:
    """Draw all."""
    options = script_options(__doc__, out=Path("page_figures"), style="paper")
    drawings: dict[str, Callable[[], Figure]] = {
        "reality_pushes": which_cone_is_real.figure,
        "reality_identified": lambda: identified_ratios(result("reality_identified")),
        "reality_errors": lambda: errors_by_pair(result("reality")),
    }
    drawings |= {module.__name__.rpartition(".")[2]: module.figure for module in DRAWN}
    with figure_style(options.style):
        for name, drawing in drawings.items():
            figure_written(drawing(), options.out, name)


if __name__ == "__main__":
    main()
