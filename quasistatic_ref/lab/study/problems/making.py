"""Problems made with their answers, family by family: resumed where the making stopped."""

import hashlib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, triu

from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.study.problems.answers import (
    NONE,
    NotKnown,
    bounded_answer,
    cone_answer,
    dense_answer,
)
from quasistatic_ref.lab.study.problems.difficulty import measures, tags
from quasistatic_ref.lab.study.problems.families.cones import cone_rows
from quasistatic_ref.lab.study.problems.families.dials import DIALS, HARVESTED, one_turned, turned
from quasistatic_ref.lab.study.problems.families.drawn import family_steps
from quasistatic_ref.lab.study.problems.families.harvest import Count
from quasistatic_ref.lab.study.problems.families.made import Made
from quasistatic_ref.lab.study.problems.folder import family_written, problems_begun, set_written
from quasistatic_ref.lab.study.problems.problem import QP, SOCP, SPARSE, Answer, Problem
from quasistatic_ref.lab.study.problems.recipe import FAMILIES
from quasistatic_ref.optional.large.sparse_form import Pattern, sparse_form
from quasistatic_ref.simulate.progress import progress_bar
from quasistatic_ref.solve.units import (
    Units,
    coordinate_units,
    natural_hessian,
    units_from,
    units_of,
)
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import standard_form

ATTEMPTS = 10
"""Draws of a problem, until it has a solution where its family has, and one that is not zero."""
UNKNOWN = Answer("", 0.0, NONE, NONE, NONE, NONE, {0: "1"})
"""In place of an answer that is still to be found."""
Kept = Mapping[str, Problem]
"""Problems by name that were made before."""
NOTHING: Kept = MappingProxyType({})
Family = Callable[[Kept, Count], Iterator[Problem]]
"""(problems made before, count of simulated steps) -> the problems of a family."""
Numbers = tuple[csr_matrix, Array, csr_matrix, Array]
"""H, g, A, b."""


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


def recipe_made(
    name: str, families: Mapping[str, int], seed: int, folder: Path, progress: bool = True
) -> list[Problem]:
    """Make a set of so many problems of each family, as :func:`set_made` does."""

    def family(one: str, count: int) -> Family:
        return lambda kept, _: family_problems(one, count, seed, kept)

    each = {one: family(one, count) for one, count in families.items()}
    return set_made(name, each, folder, sum(families.values()), progress)


def family_problems(family: str, count: int, seed: int, kept: Kept = NOTHING) -> Iterator[Problem]:
    """The problems of one family of a set with their answers.

    Steps of runs that move nothing are left out, but for those of sequences, and steps that are
    there already, in this family or in one of runs before it.

    Parameters
    ----------
    family : str
    count : int
    seed : int
    kept : mapping of str to Problem
        Made before.
    """
    if family in DIALS:
        yield from dial_problems(family, count, seed, kept)
        return
    seen: set[bytes] = set()
    names = scenario_names()
    for before in list(HARVESTED)[: list(HARVESTED).index(family)]:
        seen |= {_digest(one) for one in family_steps(before, FAMILIES[before], seed, names)}
    for one in family_steps(family, count, seed, names):
        if (digest := _digest(one)) in seen and one.sequence is None:
            continue
        seen.add(digest)
        found = problem_of(one, kept)
        if found.answer.x.any() or one.sequence is not None:
            yield found


def dial_problems(
    family: str, count: int, seed: int, kept: Kept = NOTHING, most: float | None = None
) -> Iterator[Problem]:
    """The problems of a family whose number is turned, up to `most` [its unit] or its hard end."""
    for i, one in enumerate(turned(family, count, seed, most)):
        yield _good(one, i, seed, kept)


def _digest(one: Made) -> bytes:
    """What tells the numbers of one step from those of another."""
    return hashlib.sha256(b"".join(v.tobytes() for v in standard_form(one.step))).digest()


def _good(one: Made, i: int, seed: int, kept: Kept) -> Problem:
    """The problem, or another in its place that has a solution if it should."""
    dial = DIALS[one.family]
    for again in range(ATTEMPTS):
        if again:
            assert one.dial is not None  # of every family in DIALS
            one = one_turned(one.family, one.dial, i, seed, again)
        try:
            found = problem_of(one, kept)
        except NotKnown:
            continue
        if found.feasible == dial.solvable and (not found.feasible or found.answer.x.any()):
            return found
    raise NotKnown(f"{one.id}: no draw is a problem of its family")


def problem_of(one: Made, kept: Kept = NOTHING) -> Problem:
    """A problem from a step, with its answer and what is measured of it.

    Parameters
    ----------
    one : Made
    kept : mapping of str to Problem
        Made before; one of the same name and numbers is taken.

    Raises
    ------
    NotKnown
        If its answer cannot be proved.
    """
    kind = SOCP if one.step.cone == "ellipsoid" else QP
    if SPARSE in one.tags:
        sparse = sparse_form(one.step, Pattern(one.step))
        H = csr_matrix(sparse.P + triu(sparse.P, 1).T)
        numbers: Numbers = H, sparse.g, csr_matrix(sparse.A), sparse.b
    else:
        form = cone_rows(one.step)[0] if kind == SOCP else standard_form(one.step)
        numbers = csr_matrix(form.H), form.g, csr_matrix(form.A), form.b
    before = kept.get(one.id)
    if before is not None and _same(before, numbers):
        return before
    if SPARSE in one.tags:
        units = _sparse_units(*numbers)
        plain = Problem({}, *numbers, units, UNKNOWN).natural
        answer = bounded_answer(plain.H, plain.g, plain.A, plain.b, units)
    else:
        units = units_of(form, natural_hessian(form.H))
        answer = cone_answer(one.step, form) if kind == SOCP else dense_answer(form)
    return _measured(one, kind, numbers, units, answer)


def _same(problem: Problem, numbers: Numbers) -> bool:
    H, g, A, b = numbers
    return (
        problem.H.shape == H.shape
        and problem.A.shape == A.shape
        and np.array_equal(problem.g, g)
        and np.array_equal(problem.b, b)
        and not (problem.H != H).nnz
        and not (problem.A != A).nnz
    )


def _sparse_units(H: csr_matrix, g: Array, A: csr_matrix, b: Array) -> Units:
    """Natural units of a sparse problem."""
    from scipy.sparse.linalg import spsolve

    S = coordinate_units(H.diagonal())
    rows = A.multiply(S)
    squares = np.sort(np.asarray(rows.multiply(rows).sum(axis=1)).ravel())
    energy = float(np.sqrt(g @ spsolve(csc_matrix(H), g)))
    return units_from(S, squares, energy, b)


def _measured(one: Made, kind: str, numbers: Numbers, units: Units, answer: Answer) -> Problem:
    """The problem with its line: what it is, how hard it is, how its answer is known."""
    H, g, A, b = numbers
    sequence = one.sequence and {"name": one.sequence[0], "place": one.sequence[1]}
    facts: dict[str, Any] = {
        "id": one.id,
        "family": one.family,
        "kind": kind,
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
    problem = Problem(facts, H, g + 0.0, A, b + 0.0, units, answer)
    found = measures(problem)
    facts |= {"tags": tags(problem, one.tags, found), "measures": found}
    return problem
