"""``demo``: the bunny grasped and lifted, with and without torsional friction."""

import argparse
import sys
from dataclasses import replace

import numpy as np

from quasistatic_ref.cli import options as shared
from quasistatic_ref.files.scenario.scenario import Scenario
from quasistatic_ref.files.trajectory import save_trajectory
from quasistatic_ref.lab.figures.clouds import rotations_by_case
from quasistatic_ref.lab.grasp import (
    CLOSED,
    INSTANTS,
    TOP,
    grasp_report,
    grasp_scenarios,
)
from quasistatic_ref.simulate.finding import told
from quasistatic_ref.simulate.record.failures import RunFailed
from quasistatic_ref.simulate.record.trajectory import Trajectory
from quasistatic_ref.solve.backends import DAQP, NONE
from quasistatic_ref.text.content import writable_folder


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    shared.add(parser, "--out", default="demo")
    shared.add(parser, *shared.SOLVER, "--set", "--json")


def run(options: argparse.Namespace) -> int:
    """Run both cases by the page in CVXPY, print a table, write the figure and both trajectories.

    With ``--fast`` by DAQP: the certified bits are the same.
    """
    scenarios = grasp_scenarios(shared.scenario_settings(options))
    writable_folder(options.out)
    runs: dict[str, Trajectory] = {}
    report: dict[str, dict[str, object]] = {}
    for case, scenario in scenarios.items():
        shared.progress_line(options, f"bunny_grasp {case}: {scenario.steps} steps")
        path = options.out / f"bunny_grasp_{case.replace(' ', '_')}.npz"
        slips = case == "without torsion"  # and is meant to
        if slips:
            scenario = replace(scenario, ignored_findings=("lost-grip",))
        try:
            runs[case] = scenario.run(progress=not options.quiet, findings=not slips)
        except RunFailed as failure:
            return shared.failed_run(failure, save_trajectory(path, failure.trajectory))
        for line in told(runs[case].findings, ()) if slips else ():
            print(f"quasistatic-ref: {line}", file=sys.stderr)
        save_trajectory(path, runs[case])
        report[case] = {"solver": solver_words(scenario)} | grasp_report(scenario, runs[case])
    written = _figures(scenarios["with torsion"], runs, options)
    if options.json:
        shared.print_json({"cases": report, "figures": written})
        return 0
    shared.print_rows(_table(report))
    print("the lower row of the figure slips on purpose: it has no torsional friction")
    for case, turned in rotations_by_case().items():
        least, middle, most = np.quantile(turned, (0.0, 0.5, 1.0))
        print(
            f"{len(turned)} other clouds of 992 points {case} (committed study): "
            f"{least:.2f} to {most:.1f} deg, median {middle:.2f}"
        )
    exact = sum(int((run["certificate"] == "exact").sum()) for run in runs.values())
    print(f"{exact} of {sum(run.steps for run in runs.values())} steps exact")
    print(f"wrote {', '.join(written)} and both trajectories to {options.out}")
    return 0


def solver_words(scenario: Scenario) -> str:
    """The backend of a scenario's steps, and how it is called where its name does not say so."""
    name = scenario.simulator().backend
    return name if ":" in name or name in (DAQP, NONE) else f"{name}, through CVXPY"


def _figures(
    scenario: Scenario, runs: dict[str, Trajectory], options: argparse.Namespace
) -> list[str]:
    from quasistatic_ref.lab.figures.grasp import grasp_strip
    from quasistatic_ref.optional.show.figures.style import figure_style, figure_written

    with figure_style():
        strip = grasp_strip(scenario, runs, INSTANTS, rotations_by_case())
    paths = figure_written(strip, options.out, "bunny_grasp", ["png"])
    return [path.name for path in paths]


def _table(report: dict[str, dict[str, object]]) -> list[tuple[str, ...]]:
    lift = f"t = {CLOSED:g} to {TOP:g} s"
    labels = {
        "solver": ("solved by", "{}"),
        "rotation_deg": (f"largest rotation of the bunny, {lift} [deg]", "{:.3f}"),
        "lift_mm": (f"lift height, {lift} [mm]", "{:.2f}"),
        "certified": ("certified", "{}"),
        "worst_residual": ("worst residual [natural units]", "{:.1e}"),
        "variables": ("variables", "{}"),
        "rows": ("rows", "{}"),
        "distances_ms": ("time per step: distances [ms]", "{:.2f}"),
        "rows_ms": ("time per step: rows [ms]", "{:.2f}"),
        "solve_ms": ("time per step: solve [ms]", "{:.2f}"),
        "proof_ms": ("time per step: proof [ms]", "{:.2f}"),
        "integrate_ms": ("time per step: integrate [ms]", "{:.2f}"),
    }
    rows: list[tuple[str, ...]] = [("", *report)]
    for key, (label, style) in labels.items():
        values = [case[key] for case in report.values()]
        rows.append((label, *("-" if v is None else style.format(v) for v in values)))
    return rows
