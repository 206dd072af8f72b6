"""Problems made with their answers, family by family: resumed where the making stopped."""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix

from quasistatic_ref.lab.study.problems.answers import dense_answer
from quasistatic_ref.lab.study.problems.difficulty import measures, tags
from quasistatic_ref.lab.study.problems.families.dials import DIALS, one_turned, turned
from quasistatic_ref.lab.study.problems.families.harvest import Count
from quasistatic_ref.lab.study.problems.families.made import Made
from quasistatic_ref.lab.study.problems.folder import family_written, problems_begun, set_written
from quasistatic_ref.lab.study.problems.problem import QP, Answer, Problem
from quasistatic_ref.simulate.progress import progress_bar
from quasistatic_ref.solve.units import Units, hessian_in_both_units, units_of
from quasistatic_ref.step.standard_form import StandardForm, standard_form

ATTEMPTS = 10
"""Draws of a problem, until it has a solution where its family has, and one that is not zero."""
Kept = Mapping[str, Problem]
"""Problems by name that were made before."""
NOTHING: Kept = MappingProxyType({})
Family = Callable[[Kept, Count], Iterator[Problem]]
"""(problems made before, count of simulated steps) -> the problems of a family."""


def set_made(
    name: str,
    families: Mapping[str, Family],
    folder: Path,
    total: int,
    progress: bool = True,
    **more: Any,
) -> list[Problem]:
    """Make a set and write its folder; no answer that was found before is sought again.

    Parameters
    ----------
    name : str
    families : mapping of str to callable
    folder : Path
    total : int
        Problems, and steps of the runs that they are taken from: what a bar counts.
    progress : bool
        Whether to show it on standard error, where that is a terminal.
    more : object
        What else the manifest says.

    Raises
    ------
    KeyboardInterrupt
        After Ctrl-C. The problems made so far are kept.
    """
    kept = problems_begun(folder)
    every: dict[str, list[Problem]] = {}
    with progress_bar(total=total, unit="step", words="exact answers", shown=progress) as bar:
        for family, problems_of in families.items():
            own = every[family] = []
            try:
                for one in problems_of(kept, bar.update):
                    own.append(one)
                    bar.update()
            except KeyboardInterrupt:
                before = {k: one for k, one in kept.items() if one.facts["family"] == family}
                family_written(folder, family, list((before | {p.id: p for p in own}).values()))
                raise
            family_written(folder, family, own)
    set_written(folder, name, every, **more)
    return [one for own in every.values() for one in own]


def dial_problems(
    family: str, count: int, seed: int, kept: Kept = NOTHING, most: float | None = None
) -> Iterator[Problem]:
    """The problems of a family whose number is turned, up to `most` [its unit] or its hard end."""
    for i, one in enumerate(turned(family, count, seed, most)):
        yield _good(one, i, seed, kept)


def _good(one: Made, i: int, seed: int, kept: Kept) -> Problem:
    """The problem, or another in its place that has a solution if it should."""
    dial = DIALS[one.family]
    for again in range(ATTEMPTS):
        if again:
            assert one.dial is not None  # of every family in DIALS
            one = one_turned(one.family, one.dial, i, seed, again)
        found = problem_of(one, kept)
        if found.feasible == dial.solvable and (not found.feasible or found.answer.x.any()):
            return found
    raise AssertionError(f"{one.id}: no draw is a problem of its family")


def problem_of(one: Made, kept: Kept = NOTHING) -> Problem:
    """A problem from a step, with its answer and what is measured of it.

    Parameters
    ----------
    one : Made
    kept : mapping of str to Problem
        Made before; one of the same name and numbers is taken.
    """
    form = standard_form(one.step)
    before = kept.get(one.id)
    if before is not None and _same(before, form):
        return before
    units = units_of(form, hessian_in_both_units(form.H))
    return _measured(one, form, units, dense_answer(form))


def _same(problem: Problem, form: StandardForm) -> bool:
    pairs = zip(problem.form, form, strict=True)
    return all(np.array_equal(one, other) for one, other in pairs)


def _measured(one: Made, form: StandardForm, units: Units, answer: Answer) -> Problem:
    """The problem with its line: what it is, how hard it is, how its answer is known."""
    H, g, A, b = form
    sequence = one.sequence and {"name": one.sequence[0], "place": one.sequence[1]}
    facts: dict[str, Any] = {
        "id": one.id,
        "family": one.family,
        "kind": QP,
        "n": len(g),
        "m": len(b),
        "contacts": one.step.contacts.n_c,
        "h": one.step.h,
        "k": one.k,
        "mass_ratio": one.mass_ratio,
        "dial": one.dial,
        "sequence": sequence,
        "status": answer.status,
        "answer": {
            "kind": answer.kind,
            "error": answer.error,
            "walks": answer.walks,
            "unique_multipliers": answer.unique,
            "differentiable": answer.differentiable,
        },
        "tags": list(one.tags),
    }
    problem = Problem(facts, csr_matrix(H), g + 0.0, csr_matrix(A), b + 0.0, units, answer)
    found = measures(problem)
    facts |= {"tags": tags(problem, one.tags, found), "measures": found}
    return problem
