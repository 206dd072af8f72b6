"""Correct digits of each backend on every step of both bunny_grasp runs, at several settings.

Run ``python -m validation.make.digits_of_backends`` (about two minutes; the extra ``test`` brings
DAQP). Each step is solved twice: as it is, in SI units, and in natural units, as `solve_step`
solves it. "default" is the solver as it comes, through CVXPY, with none of our options; the others
are accuracies at which our table of options is used. The truth is the certified optimum of the
step. Writes validation/results/digits_of_backends.csv and docs/figures/digits_of_backends.png.
"""

from __future__ import annotations

import csv
import sys
import warnings
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from shutil import copyfile
from tempfile import TemporaryDirectory

import numpy as np
from tqdm import tqdm

from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.lab.digits import correct_digits
from quasistatic_ref.lab.figures.digits import BackendDigits, digits_of_backends
from quasistatic_ref.lab.grasp import CASES
from quasistatic_ref.optional.show.figures.style import figure_written
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.solve.scaled import DenseStep
from quasistatic_ref.solve.through_cvxpy import CvxpySolver, cvxpy_reply
from quasistatic_ref.solve.units import from_natural
from quasistatic_ref.step.data import Array, StepData

ROOT = Path(__file__).parents[2]
RESULTS = ROOT / "validation" / "results" / "digits_of_backends.csv"
FIGURES = ROOT / "docs" / "figures"
BACKENDS = ("clarabel", "osqp", "piqp", "daqp")
DEFAULT = "default"
ACCURACIES = (DEFAULT, "1e-3", "1e-6", "1e-9", "1e-12")
NUMBERS = ("worst", "low", "median", "best")
SUBJECT = "all 600 steps of both runs of bunny_grasp, h = 10 ms, friction pyramid"
RAW, NATURAL = "raw units (m, rad, kg)", "natural units"


def grasp_steps() -> list[tuple[StepData, Array]]:
    """Every step of both runs, with its certified optimum."""
    return [step for own in CASES.values() for step in steps_of(own)]


def steps_of(own: list[str]) -> list[tuple[StepData, Array]]:
    """Every step of one run of the grasp with these settings, with its certified optimum."""
    run = load_scenario("bunny_grasp", own, fast=True).run()
    assert set(run["certificate"]) == {"exact"}
    return [(run.step_data(k), run["delta_q"][k]) for k in range(run.steps)]


@dataclass(frozen=True, eq=False)
class AsItIs:
    """A step that is handed over in SI units, as if they were natural."""

    step: StepData

    @property
    def natural(self) -> StepData:
        """The same."""
        return self.step


def answered(solver: CvxpySolver, step: StepData, units: str, accuracy: str) -> Array | None:
    """The delta_q that a backend gives [m, rad]; None if it gives none."""
    scaled = AsItIs(step) if units == RAW else DenseStep(step)
    if accuracy == DEFAULT:
        solver.write(scaled)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # "may be inaccurate": its status says so too
            try:
                reply = cvxpy_reply(solver.problem, solver.name, {}, warm=False)
            except Exception:  # whatever a solver raises, it has not solved the step
                return None
        delta_q = reply.x if reply.solved else None
    else:
        try:
            delta_q = solver.answer(scaled, float(accuracy)).delta_q
        except StepNotSolved:
            return None
    if delta_q is None or isinstance(scaled, AsItIs):
        return delta_q
    return from_natural(delta_q, np.zeros(0), scaled.units)[0]


def measured(steps: list[tuple[StepData, Array]]) -> Iterator[BackendDigits]:
    """One record for each backend, setting and kind of units."""
    cells = [(u, b, a) for u in (RAW, NATURAL) for b in BACKENDS for a in ACCURACIES]
    for units, backend, accuracy in (bar := tqdm(cells)):
        bar.set_description(f"{units}, {backend} at {accuracy}")
        found, solver = [], CvxpySolver(steps[0][0], backend)
        for step, x in steps:
            # The two runs have other mu, and so other problems.
            solver = solver if solver.fits(step) else CvxpySolver(step, backend)
            delta_q = answered(solver, step, units, accuracy)
            found.append(None if delta_q is None else correct_digits(step, delta_q, x).delta_q)
        solved = np.array([d for d in found if d is not None])
        quantiles = np.quantile(solved, [0, 0.01, 0.5, 1]) if solved.size else np.full(4, np.nan)
        worst, low, median, best = (float(f"{q:.2f}") for q in quantiles)
        counts = len(found), len(found) - solved.size
        yield BackendDigits(units, backend, accuracy, *counts, worst, low, median, best)


def records_read() -> list[BackendDigits]:
    """The committed results."""
    kinds = {"steps": int, "unsolved": int} | dict.fromkeys(NUMBERS, float)
    with RESULTS.open(newline="") as file:
        return [
            BackendDigits(**{name: kinds.get(name, str)(text) for name, text in row.items()})
            for row in csv.DictReader(file)
        ]


def main() -> int:
    """Measure, write the table and the figure; with ``--figure`` draw from the table alone."""
    if "--figure" in sys.argv[1:]:
        records = records_read()
    else:
        records = list(measured(grasp_steps()))
        _records_written(records)
    with TemporaryDirectory() as folder:
        png, *_ = figure_written(digits_of_backends(records, SUBJECT), folder, RESULTS.stem)
        copyfile(png, FIGURES / png.name)
    print(RESULTS.read_text(), end="")
    return 0


def _records_written(records: list[BackendDigits]) -> None:
    RESULTS.parent.mkdir(exist_ok=True)
    with RESULTS.open("w", newline="") as file:
        names = [field.name for field in fields(BackendDigits)]
        table = csv.DictWriter(file, names, lineterminator="\n")
        table.writeheader()
        table.writerows(asdict(record) for record in records)


if __name__ == "__main__":
    sys.exit(main())
