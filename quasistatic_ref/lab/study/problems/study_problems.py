"""The test set of a study: made once, from a seed, and kept in a folder with its exact answers."""

import hashlib
import json
import math
import shutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from itertools import chain
from pathlib import Path
from typing import Any, Final

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import json_read, json_text, text_written, written_whole
from quasistatic_ref.formats.npz import npz_arrays
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.lab.study.file.study_file import TestSet
from quasistatic_ref.lab.study.problems.families.harvest import (
    Count,
    harvested,
    no_count,
    scenario_of,
    scenario_run,
    stepped_again,
)
from quasistatic_ref.lab.study.problems.families.made import Made
from quasistatic_ref.lab.study.problems.families.scaled import slabs, towers
from quasistatic_ref.lab.study.problems.qp import (
    INFEASIBLE,
    Facts,
    NoSolution,
    Problem,
    Truth,
    condition,
    kind_of,
    units_of,
)
from quasistatic_ref.lab.study.problems.selection import problems_taken, set_identity
from quasistatic_ref.lab.study.problems.truth import answer_of
from quasistatic_ref.lab.study.store.schema import FACT
from quasistatic_ref.lab.study.store.store import lines_read
from quasistatic_ref.simulate.progress import progress_bar
from quasistatic_ref.solve.units import natural_form
from quasistatic_ref.step.standard_form import StandardForm, standard_form

FORMAT, VERSION = "quasistatic-ref/study-problems", 2
"""Version 1 came from other scenes, and its rows were rounded in another order."""
HEADER, FACTS, NUMBERS = "problems.json", "problems.jsonl", "problems.npz"
BEGUN = "begun"
"""The folder within a store that has the problems of a test set that is not yet whole."""
NAMES: Final = ("H", "g", "A", "b", "delta_q", "net")
FARKAS: Final = "farkas"  # one array more, where some problems have no solution
AGAIN = "bunny_grasp"
"""The scenario whose steps are formed again at other h and k: the paper's own."""
CLOSEST = (1, 2, 3, 5, 8, 13, 20, 32, 50)
TIME_STEPS = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4)
MOST_CONTACTS, MOST_RATIO, MOST_BODIES = 1000, 1e9, 40


def scenarios_run(test_set: TestSet) -> list[str]:
    """The scenarios whose runs a test set is taken from."""
    count, names = test_set.families, test_set.scenarios
    share = _shares(count["scenarios"], len(names))
    again = [AGAIN] if count["time_step"] > 1 or count["closest_points"] else []
    return list(dict.fromkeys([n for n, c in zip(names, share, strict=True) if c] + again))


def made(test_set: TestSet, count_steps: Count = no_count) -> Iterator[Made]:
    """Every step of a test set, family by family.

    Parameters
    ----------
    test_set : TestSet
    count_steps : callable
        Is called with the number of steps of scenarios that were just simulated.
    """
    count, seed = test_set.families, test_set.seed
    names, most = test_set.scenarios, test_set.most
    for name in scenarios_run(test_set):
        scenario_run(name, count_steps)
    share = _shares(count["scenarios"], len(names))
    yield from chain.from_iterable(harvested(n, c) for n, c in zip(names, share, strict=True) if c)
    if n := count["contacts"]:
        yield from slabs(
            "contacts", "contacts", _scale(1, most.get("contacts", MOST_CONTACTS), n).round(), seed
        )
    if n := count["mass_ratio"]:
        yield from slabs(
            "mass_ratio", "ratio", _scale(1, most.get("mass_ratio", MOST_RATIO), n), seed
        )
    if n := count["time_step"]:
        yield from slabs("time_step", "h", _scale(TIME_STEPS[0], TIME_STEPS[-1], -(-n // 2)), seed)
        share = _shares(n // 2, len(TIME_STEPS))
        for i, (h, c) in enumerate(zip(TIME_STEPS, share, strict=True)):
            yield from stepped_again("time_step", AGAIN, [f"h={h}"], c, i)
    if n := count["closest_points"]:
        share = _shares(n, len(CLOSEST))
        for i, (k, c) in enumerate(zip(CLOSEST, share, strict=True)):
            changes = [f"contacts.grip.k={k}", f"contacts.floor.k={k}"]
            yield from stepped_again("closest_points", AGAIN, changes, c, i)
    if n := count["bodies"]:
        bodies = _scale(2, most.get("bodies", MOST_BODIES), n)
        yield from towers([int(v) for v in bodies.round()], seed)


def _scale(first: float, last: float, count: int) -> np.ndarray:
    return np.geomspace(first, last, count)


def _shares(count: int, parts: int) -> list[int]:
    return [count // parts + (i < count % parts) for i in range(parts)]


def problem_of(one: Made, before: Problem | None = None) -> Problem:
    """The quadratic program of a step, with its exact answer.

    Parameters
    ----------
    one : Made
    before : Problem, optional
        Made before; if its numbers are the same, its answer is taken.
    """
    form = standard_form(one.step)
    n_c = one.step.contacts.n_c
    facts = Facts(one.id, one.family, n_c, one.mass_ratio, one.step.h, one.k)
    same = before is not None and bits(before.form) == bits(form)
    return Problem(facts, form, before.answer if before and same else answer_of(form))


def problem_set(test_set: TestSet, folder: str | Path, progress: bool = True) -> list[Problem]:
    """The problems of a test set: those in the folder, or made and written there.

    Parameters
    ----------
    test_set : TestSet
    folder : str or Path
    progress : bool
        Whether to show a bar on standard error, where that is a terminal.

    Returns
    -------
    list of Problem

    Raises
    ------
    InputError
        If the folder holds another test set.
    KeyboardInterrupt
        After Ctrl-C. The problems made so far are kept, and their answers not sought again.
    """
    folder = Path(folder)
    made_of = _made_of(test_set)
    if (folder / HEADER).exists():
        there = _head(folder)
        if {name: there.get(name) for name in made_of} != json.loads(json_text(made_of)):
            raise InputError(
                "holds another test set; choose another folder with --out, or remove this one",
                file=folder,
            )
        return problems_read(folder)
    if test_set.source:
        taken = problems_taken(test_set)
        _written(taken, made_of, folder)
        return taken
    # The bar counts steps: those of the runs that problems are taken from, and the problems.
    total = sum(test_set.families.values())
    begun = folder / BEGUN
    kept = {p.id: p for p in problems_read(begun)} if (begun / HEADER).exists() else {}
    problems: dict[str, Problem] = {}
    with progress_bar(total=total, unit="step", words="exact answers", shown=progress) as bar:
        bar.total += sum(scenario_of(name).steps for name in scenarios_run(test_set))
        try:
            for one in made(test_set, bar.update):
                problems[one.id] = problem_of(one, kept.get(one.id))
                bar.update()
        except KeyboardInterrupt:
            if problems:
                _written(list((kept | problems).values()), made_of, begun)
            raise
    _written(list(problems.values()), made_of, folder)
    shutil.rmtree(begun, ignore_errors=True)
    return list(problems.values())


def problems_read(folder: str | Path) -> list[Problem]:
    """The problems in a folder.

    Raises
    ------
    InputError
        If it holds no test set, or one whose numbers were changed.
    """
    folder = Path(folder)
    head, lines = _head(folder), lines_read(folder / FACTS, FACT)
    arrays = npz_arrays(folder / NUMBERS, "the numbers of a test set")
    names = [*NAMES, *{FARKAS for said in lines if said["kind"] == INFEASIBLE}]
    sizes = {n: (sum(math.prod(_shapes(said)[n]) for said in lines),) for n in names}
    if (
        head.get("format") != FORMAT
        or {name: array.shape for name, array in arrays.items()} != sizes
        or head.get("sha256") != _digest(arrays)
    ):
        raise InputError("is no test set, or was changed; remove the folder", file=folder)
    at = dict.fromkeys(names, 0)
    problems = []
    for said in lines:
        numbers = {}
        for name in names:
            shape = _shapes(said)[name]
            size = math.prod(shape)
            numbers[name] = arrays[name][at[name] : at[name] + size].reshape(shape)
            at[name] += size
        facts = Facts(**{key: said[key] for key in Facts.__dataclass_fields__})
        form = StandardForm(*(numbers[name] for name in NAMES[:4]))
        answer = (NoSolution(numbers[FARKAS]) if said["kind"] == INFEASIBLE else
                  Truth(numbers["delta_q"], numbers["net"], said["bound"]))  # fmt: skip
        problems.append(Problem(facts, form, answer))
    return problems


def _shapes(said: Mapping[str, Any]) -> dict[str, tuple[int, ...]]:
    n, m, none = said["n"], said["m"], said["kind"] == INFEASIBLE
    known = (0,) if none else (n,)
    return {"H": (n, n), "g": (n,), "A": (m, n), "b": (m,), "delta_q": known, "net": known,
            FARKAS: (m,) if none else (0,)}  # fmt: skip


def _head(folder: Path) -> dict[str, Any]:
    head = json_read(folder / HEADER)
    if not isinstance(head, dict):
        raise InputError("must be a table", file=folder / HEADER, value=head)
    return head


def set_record(problems: Sequence[Problem]) -> dict[str, Any]:
    """How many problems of which family there are, and their fingerprint."""
    families: dict[str, int] = {}
    for problem in problems:
        families[problem.facts.family] = families.get(problem.facts.family, 0) + 1
    return {
        "count": len(problems),
        "exact": sum(kind_of(problem.answer) == "exact" for problem in problems),
        "families": families,
        "sha256": _digest(_flat(problems)),
    }


def _made_of(test_set: TestSet) -> dict[str, Any]:
    return {
        "format": FORMAT,
        "version": VERSION,
        "seed": test_set.seed,
        "asked": dict(test_set.families),
        "scenarios": list(test_set.scenarios),
        **({"most": dict(test_set.most)} if test_set.most else {}),
        **({"set": set_identity(test_set.source)} if test_set.source else {}),
    }


def _written(problems: Sequence[Problem], made_of: dict[str, Any], folder: Path) -> None:
    """Write the header last: a folder that has one is complete."""
    lines = []
    for problem in problems:
        form = problem.form
        lines.append(
            json_text(
                asdict(problem.facts)
                | {
                    "n": len(form.g),
                    "m": len(form.b),
                    "condition": condition(form),
                    "condition_natural": condition(natural_form(form, units_of(form))),
                    "kind": kind_of(problem.answer),
                    "bound": getattr(problem.answer, "bound", 0.0),
                }
            )
        )
    arrays: dict[str, Any] = _flat(problems)
    text_written(folder / FACTS, "\n".join(lines) + "\n")
    written_whole(folder / NUMBERS, lambda file: np.savez_compressed(file, **arrays))
    text_written(folder / HEADER, json_text(made_of | set_record(problems)) + "\n")


def _flat(problems: Sequence[Problem]) -> dict[str, np.ndarray]:
    """Arrays of one kind after one another."""
    parts: dict[str, list[np.ndarray]] = {name: [np.zeros(0)] for name in NAMES}
    for problem in problems:
        for owner in (problem.form, problem.answer):
            for name in (n for n in (*NAMES, FARKAS) if hasattr(owner, n)):
                parts.setdefault(name, []).append(np.ravel(getattr(owner, name)))
    return {name: np.concatenate(arrays) for name, arrays in parts.items()}


def _digest(arrays: dict[str, np.ndarray]) -> str:
    digest = hashlib.sha256()
    for name in (*NAMES, *({FARKAS} & set(arrays))):
        digest.update(np.ascontiguousarray(arrays[name]).tobytes())
    return digest.hexdigest()
