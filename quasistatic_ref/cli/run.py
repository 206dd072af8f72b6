"""``run SCENARIO``: simulate a scenario and write its trajectory."""

import argparse
import sys
from collections.abc import Mapping
from os.path import isfile
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.cli import options as shared
from quasistatic_ref.cli.ignored import unknown_elements
from quasistatic_ref.errors import InputError, about_file
from quasistatic_ref.files.finding import finding_table
from quasistatic_ref.files.npz import header_of, npz_arrays
from quasistatic_ref.files.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.files.trajectory import FORMAT, WHAT, save_trajectory
from quasistatic_ref.parts import is_there, needing, part
from quasistatic_ref.simulate.law import COULOMB
from quasistatic_ref.simulate.record.failures import RunFailed
from quasistatic_ref.simulate.record.trajectory import NOT_PROVED, Trajectory, certified
from quasistatic_ref.step.cones import cone
from quasistatic_ref.text.content import writable_folder
from quasistatic_ref.text.table_reader import TableReader


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument(
        "scenario",
        help="a TOML file, the name of an installed scenario (bunny_grasp, ...), or a MuJoCo scene "
        "(.xml)",
    )
    shared.add(parser, "--out", default="results")
    shared.add(parser, *shared.SOLVER, "--law", "--set", "--root", "--ignore", "--json")
    parser.add_argument(
        "--targets",
        metavar="FILE.csv|KEY,KEY,...",
        help="targets of a MuJoCo scene: keyframes, or a table of t and controls or joints",
    )
    parser.add_argument("--keyframe", metavar="KEY", help="keyframe in which a MuJoCo scene starts")
    parser.add_argument(
        "--sweep",
        action="append",
        dest="sweeps",
        metavar="FIELD=FIRST:LAST:COUNT",
        help="run the scenario with each of these values, or FIELD=VALUE,VALUE,...; several make a "
        "grid, and FIELD,FIELD=... sets both to the same",
    )
    parser.add_argument(
        "--jobs", type=int, metavar="N", help="runs of a sweep at once (default: all cores)"
    )
    parser.add_argument(
        "--strict", action="store_true", help="end with status 1 if a finding is grave"
    )
    parser.add_argument(
        "--replace", action="store_true", help="overwrite a run of another scene, or a longer one"
    )
    parser.add_argument(
        "--numbers",
        action="store_true",
        help="print the numbers of all bodies and joints, and a table of all pairs",
    )
    parser.add_argument(
        "--table",
        type=Path,
        metavar="FILE",
        help="write a row for each step, with positions, targets and sums of pairs: FILE.csv "
        "(extra 'pandas') or FILE.parquet (extra 'parquet' as well)",
    )
    parser.add_argument(
        "--contacts-table",
        type=Path,
        metavar="FILE",
        help="write a row for each contact and step to a file like that of --table",
    )
    parser.add_argument(
        "--view",
        action="store_true",
        help="write an HTML file that plays the run in 3-D, without network (extra 'view')",
    )


def run(options: argparse.Namespace) -> int:
    """Simulate the scenario of the options, write its trajectory and print a summary.

    InputError if an option does not suit the scene.

    The exit status is 3 if a step has no solution; the steps before it are written. With
    ``--strict`` it is 1 if a finding is grave.
    """
    scenario = scenario_of(options)
    path = options.out / f"{scenario.path.stem}.npz"
    if options.out.suffix == ".npz":
        problem = f"is a folder, in which {path.name} is written; name a folder"
        raise InputError(problem, field="--out", value=str(options.out))
    check_replaceable(path, scenario, options.replace)
    writable_folder(options.out)
    tables = {"--table": options.table, "--contacts-table": options.contacts_table}
    tables = {option: file for option, file in tables.items() if file is not None}
    _check_parts(options, tables)
    if unknown := unknown_elements(scenario.system):
        print(f"quasistatic-ref: {unknown}", file=sys.stderr)
    try:
        trajectory = scenario.run(progress=not options.quiet)
    except RunFailed as failure:
        return shared.failed_run(failure, path)
    save_trajectory(path, trajectory)
    written = [path]
    for option, file in tables.items():
        with needing(option):
            from quasistatic_ref.optional.show.table import table_written
        table_written(trajectory, file, option)
        written.append(file)
    summary = summary_record(scenario, trajectory, path)
    if options.view:
        with needing("--view"):
            from quasistatic_ref.optional.show.figures.viewer import save_view
        view = save_view(path.with_suffix(".html"), scenario, trajectory)
        summary["view"] = str(view)
        written.append(view)
    numbers: Mapping[str, Any] = {}
    if is_there("doctor"):
        from quasistatic_ref.optional.doctor.did import lines
        from quasistatic_ref.optional.doctor.did import numbers as did

        numbers = did.numbers_of(trajectory, scenario)
    if options.json:
        shared.print_json(summary | {"numbers": numbers})
    else:
        _print(summary)
        if numbers:
            print(lines.artifact_line(trajectory.header))
            for line in lines.lines(numbers, options.numbers):
                shared.print_wrapped(line, "    ")
            if options.numbers:
                shared.print_rows(lines.pair_rows(numbers))
        times = summary["milliseconds_per_step"].items()
        if times:
            print(f"ms per step: {', '.join(f'{stage} {ms:.2f}' for stage, ms in times)}")
        print(f"wrote {' and '.join(map(str, written))}")
    return int(options.strict and any(finding.grave for finding in trajectory.findings))


def _check_parts(options: argparse.Namespace, tables: Mapping[str, Path]) -> None:
    """Refuse an option whose optional part or package is missing, before anything is simulated."""
    if options.view:
        with needing("--view"):
            from quasistatic_ref.optional.show.figures.viewer import viewer_package
        viewer_package()
    for option, file in tables.items():
        with needing(option):
            from quasistatic_ref.optional.show.table import check_table_path
        check_table_path(file, option)
    if options.strict:
        part("doctor", "--strict")


def summary_record(scenario: Scenario, trajectory: Trajectory, path: Path) -> dict[str, Any]:
    """The summary of a run that ``--json`` prints, as plain data."""
    header = trajectory.header
    record: dict[str, Any] = {
        "trajectory": str(path),
        "steps": trajectory.steps,
        "backend": scenario.backend,
        "fast": scenario.fast,
        "law": scenario.law,
        "variables": scenario.system.n_v,
        "rows": int(cone(scenario.cone).counts(trajectory["rows"]).sum()),
        "certified": certified(trajectory),
        "worst_residual": worst_residual(trajectory),
        "quasi_dynamic_number": header.quasi_dynamic_number,
        "largest_boundary_layer": header.largest_boundary_layer,
        "milliseconds_per_step": {
            stage: 1e3 * float(seconds.mean()) for stage, seconds in trajectory.seconds.items()
        },
        "findings": [finding_table(finding) for finding in trajectory.findings],
        "ignored_findings": [finding_table(one) for one in trajectory.ignored_findings],
        "not_looked_at": header.not_looked_at,
    }
    if scenario.law == COULOMB:
        record["s_iterations"] = trajectory["s_iterations"].tolist()
        record["largest_s_residual"] = float(trajectory["s_residual"].max(initial=0.0))
    return record


def _print(summary: Mapping[str, Any]) -> None:
    print(f"{summary['steps']} steps of {summary['variables']} variables x {summary['rows']} rows")
    residual = summary["worst_residual"]
    worst = "not computed" if residual is None else f"{residual:.1e} (natural units)"
    speed = "fast" if summary["fast"] else "plain"
    solved = f"backend {summary['backend']}, {speed} path, worst residual {worst}"
    proved = summary["certified"]
    print(proved if NOT_PROVED in proved else f"{proved}; {solved}")
    iterations = summary.get("s_iterations")
    if iterations:
        print(
            f"Coulomb's law: {np.mean(iterations):.1f} iterations a step, at most "
            f"{max(iterations)}; s is its own to within {summary['largest_s_residual']:.1e} m"
        )


def check_replaceable(path: Path, scenario: Scenario, replace: bool) -> None:
    """Refuse to overwrite a file, unless it is a run of this scene that is no longer than its own.

    Parameters
    ----------
    path : Path
    scenario : Scenario
    replace : bool
        Whether any run may be overwritten.

    Raises
    ------
    InputError
    """
    if not isfile(path) or not path.stat().st_size:  # false of a name that is too long
        return
    try:
        header = npz_arrays(path, WHAT, only="header").get("header")
        top = TableReader(header_of(path, WHAT, header))
        top.text("format", choices=(FORMAT,))
        there = top.integer("steps", least=0)
        of_scene = top.text("scene_sha256", "")
    except InputError as error:
        problem = f"{error.problem}; it is not replaced by one; choose another folder, or remove it"
        raise InputError(problem, file=path) from None
    if replace:
        return
    if of_scene != scenario.fingerprint or not of_scene:
        raise InputError("is a run of another scene; --replace overwrites it", file=path)
    if there > scenario.steps:
        problem = f"is a longer run of this scene, of {there} steps; --replace overwrites it"
        raise InputError(problem, file=path)


def scenario_of(options: argparse.Namespace) -> Scenario:
    """The scenario of a file or a name, or a MuJoCo scene.

    Raises
    ------
    InputError
        If it cannot be, or an option is for the other kind.
    """
    settings = shared.scenario_settings(options)
    path = Path(options.scenario)
    if path.suffix != ".xml":
        for option in ("targets", "keyframe"):
            if getattr(options, option) is not None:
                raise InputError("is for a MuJoCo scene (.xml)", field=f"--{option}")
        return load_scenario(options.scenario, settings)
    with needing("a MuJoCo scene"):
        from quasistatic_ref.optional.mujoco.compiler import compiled_model
        from quasistatic_ref.optional.mujoco.scene import mujoco_scenario, words
        from quasistatic_ref.optional.mujoco.settled import settled
    with about_file(path):
        model = compiled_model(path, options.roots)
        keyframe = options.keyframe
        data = None if keyframe is None else settled(model, 0.0, keyframe)
        source = options.targets
        table = source is None or source.endswith(".csv")
        targets = source if table else source.split(",")
        scene = mujoco_scenario(model, data, targets, settings, path)
    shared.progress_line(options, words(scene))
    return scene


def worst_residual(trajectory: Trajectory) -> float | None:
    """Largest residual of all steps, in natural units [-]; None where none was computed."""
    residuals = trajectory["worst_residual"]
    if not residuals.size or np.isnan(residuals).any():
        return None
    return float(residuals.max())
