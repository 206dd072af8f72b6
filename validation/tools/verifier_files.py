"""The steps and solutions that both checkers of solution files judge.

Solutions that are right (of all steps of the vectors, the bunny's grasp and random steps:
degenerate, with rows of the user's own, infeasible, in every cone), steps that are written in other
ways, and forged solutions, each with what `verify` of the package says of it.
"""

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from quasistatic_ref import (
    Extra,
    InputError,
    StepData,
    StepIllPosed,
    StepInfeasible,
    StepNotSolved,
    load_scenario,
    solve_step,
    step_read,
)
from quasistatic_ref.cli.solution_files import infeasible_text, solution_read, solution_text
from quasistatic_ref.lab.vectors.files import inputs_read
from quasistatic_ref.lab.vectors.layers.qp import step_of
from quasistatic_ref.lab.vectors.own.step import posed_case
from quasistatic_ref.step.files import step_text
from tests.oracles.forged_scenes import scenes
from tests.oracles.forgeries import at_random, forgeries, good_file, refutation
from tests.oracles.random_steps import mixed_step
from tests.oracles.single_faults import single_faults
from tests.oracles.solution_truth import truth_of
from validation.tools.scripts import ROOT

VECTORS = ROOT / "validation" / "vectors"
CONES = ("pyramid", "product", "facets-6", "facets-32", "frictionless", "ellipsoid")
CASES = {"torsion": [], "no torsion": ["contacts.grip.mu_omega=0"]}


class Case(NamedTuple):
    """Two texts, the verdict of `verify`, which fields were forged, and the only right reason."""

    family: str
    step: str
    solution: str
    refusal: str | None
    forged: frozenset[str] = frozenset()
    reason: str = ""


def verify_refusal(folder: Path, step: str, solution: str) -> str | None:
    """Why the command `verify` refuses two texts, as files of a folder; None where it does not."""
    paths = folder / "step.json", folder / "solution.json"
    for path, text in zip(paths, (step, solution), strict=True):
        path.write_text(text)
    try:
        posed = step_read(paths[0])
        return refutation(posed, solution_read(paths[1], posed))
    except InputError as error:
        return str(error)


class Cases:
    """Cases from steps and records, judged by `verify` in a folder of their own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def case(
        self, family: str, step: str, solution: str, forged: frozenset[str] = frozenset()
    ) -> Case:
        """Two texts and what `verify` says of them."""
        refusal = verify_refusal(self.folder, step, solution)
        return Case(family, step, solution, refusal, forged)

    def solved_cases(self, family: str, step: StepData) -> Iterator[Case]:
        """A step with its exact solution, or with the proof that it has none."""
        try:
            yield self.case(family, step_text(step), solution_text(solve_step(step)))
        except StepInfeasible as proof:
            if proof.farkas is not None and proof.farkas.exact is not None:
                text = infeasible_text(step, proof.farkas.exact)
                yield self.case(f"{family}, infeasible", step_text(step), text)
        except (StepIllPosed, StepNotSolved):
            return

    def forged_cases(self, every: int, number: int) -> Iterator[Case]:
        """Each kind of solution as it is and forged, one field at a time and several at random."""
        for (kind, _), step in scenes(every=every == 1).items():
            good = good_file(step, kind)
            text = step_text(step)
            truth = truth_of(step, good)
            yield self.case(f"{kind}, as it is", text, json.dumps(good))
            for k, (_, record) in enumerate(forgeries(step, good)):
                if k % every == 0:
                    yield self.forged_case(f"{kind}, forged", text, record, good, truth)
            rng = np.random.default_rng(1)
            for record in (at_random(rng, step, good) for _ in range(number)):
                if record != good:
                    family = f"{kind}, forged at random"
                    yield self.forged_case(family, text, record, good, truth)

    def forged_case(
        self, family: str, text: str, record: Any, good: Any, truth: Callable[[Any], bool]
    ) -> Case:
        """A forged record; one that `verify` verifies although it is not true ends the script."""
        case = self.case(family, text, json.dumps(record), changed_fields(record, good))
        if case.refusal is None and not truth(record):
            raise SystemExit(f"{family}, not true, and verified: {case.solution}")
        return case


def changed_fields(record: object, good: dict[str, Any]) -> frozenset[str]:
    """Names of the fields of a solution that were forged, those of its certificate among them."""
    if not isinstance(record, dict):
        return frozenset()
    names = {name for name in {*record, *good} if record.get(name) != good.get(name)}
    if isinstance(record.get("certificate"), dict) and "certificate" in names:
        names = names - {"certificate"} | changed_fields(record["certificate"], good["certificate"])
    return frozenset(names)


def vector_steps() -> Iterator[StepData]:
    """The quadratic programs of the vectors' layer qp, as steps whose rows are the user's own."""
    for case in inputs_read(VECTORS, "qp"):
        if "second_order" not in case.input:
            yield step_of(case.input)


def mechanism_steps() -> Iterator[StepData]:
    """The steps of the vectors' layer step, as the package's own simulators pose them."""
    for case in inputs_read(VECTORS, "step"):
        yield posed_case(case.input).step


def random_steps(count: int) -> Iterator[tuple[str, StepData]]:
    """Steps in every cone, each third with rows of the user's own that repeat or oppose others."""
    for seed in range(count):
        step = mixed_step(seed).replace(cone=CONES[seed % len(CONES)])
        if seed % 3 == 0:
            rng = np.random.default_rng(seed)
            A = rng.standard_normal((3, step.n_v))
            A[1] = rng.choice([1.0, -1.0, -2.0]) * A[0]
            step = step.replace(extra=Extra(("a", "b", "c"), A, 1e-4 * rng.choice([-1.0, 0.0], 3)))
        yield f"random, {step.cone}", step


def other_texts(text: str) -> Iterator[str]:
    """A step's file as others may write it: some are the same step, some are none."""
    record = json.loads(text)
    yield json.dumps(record, indent=3, sort_keys=True)
    yield text.replace(".0,", ",").replace(".0]", "]")
    yield text.replace("0.0,", "-0.0,")
    yield text.replace("0.01", "1.0E-02").replace("0.3", "3000000000000000000001e-22")
    yield text.replace('"version": 1', '"version": 1.0')
    yield text.replace('"n_a": ', '"n_a": 1e0, "n_a": ')
    yield text[:-2] + ', "note": 1}'
    yield "\ufeff" + text
    for key, value in (
        ("cone", "facets-04"), ("cone", "facets-5"), ("cone", None), ("n_a", -1), ("n_a", True),
        ("h", 0.0), ("h", -1.0), ("h", "0.01"), ("h", 10**400), ("version", True), ("contacts", {}),
        ("extra", {"names": [], "A": [], "b": []}), ("extra", None), ("format", "x"),
        ("h", 5e-324), ("h", 1e300), ("h", 1),
    ):  # fmt: skip
        yield json.dumps(record | {key: value})
    without = {key: value for key, value in record.items() if key != "cone"}
    yield json.dumps(without)
    for key, value in (
        ("name", 'a"\\\n\t\x01\x7f\u00e9\u2028\U0001f600/'), ("name", 1), ("mu_v", -0.1),
        ("name", "\ud800"), ("d1", [1.0, 9e-10, 0.0]), ("d1", [1.0, 1.1e-9, 0.0]), ("rows", 5),
        ("rows", 4), ("rows", 6.0), ("rows", True), ("mu_omega", -0.0), ("n", [0.0, 0.0, 2.0]),
        ("n", [0, 0, 1]), ("phi", 1), ("phi", None), ("J", []), ("mu_omega", 1e-5), ("phi", 1.5e16),
        ("phi", 123456789012345680.0), ("phi", 1e15), ("phi", 0.0001), ("phi", 1e22),
    ):  # fmt: skip
        yield json.dumps(record | {"contacts": [record["contacts"][0] | {key: value}]})
    matrix = record["M_u"] if record["M_u"] else record["K_q"]
    for shift in (1e-13, 1e-9):
        changed = [list(row) for row in matrix]
        changed[0][1] += shift * changed[0][0]
        yield json.dumps(record | {"M_u" if record["M_u"] else "K_q": changed})


def written_otherwise(cases: Cases) -> Iterator[Case]:
    """Other texts of two steps, each with the solution of what it says, if it says a step."""
    for (kind, name), step in scenes().items():
        if kind != "exact":
            continue
        good = json.dumps(good_file(step, kind))
        for text in other_texts(step_text(step)):
            yield cases.case(f"written otherwise, {name}", text, good)
            try:
                posed = step_read(cases.folder / "step.json")  # where the text was judged
                solution = solution_text(solve_step(posed))
            except (InputError, StepInfeasible, StepIllPosed, StepNotSolved):
                continue
            yield cases.case(f"written otherwise, {name}", text, solution)


def all_cases(folder: Path, whole: bool) -> Iterator[Case]:
    """Everything that the two checkers judge."""
    cases = Cases(folder)
    for k, step in enumerate(vector_steps()):
        if whole or k % 5 == 0:
            yield from cases.solved_cases("vectors, layer qp", step)
    for k, step in enumerate(mechanism_steps()):
        if whole or k % 9 == 0:
            yield from cases.solved_cases("vectors, layer step", step)
    for name, settings in CASES.items():
        run = load_scenario("bunny_grasp", settings, fast=True).run(progress=False)
        for k in range(0, len(run), 1 if whole else 30):
            yield from cases.solved_cases(f"bunny_grasp, {name}", run.step_data(k))
    for family, step in random_steps(2000 if whole else 60):
        yield from cases.solved_cases(family, step)
    for step_file, record, reason in single_faults():
        yield cases.case("one fault alone", step_file, record)._replace(reason=reason)
    yield from written_otherwise(cases)
    yield from cases.forged_cases(1 if whole else 7, 500 if whole else 40)
