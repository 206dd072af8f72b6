"""The problems of a recipe, made with their answers, family by family: resumed where it stopped."""

import hashlib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix, triu

from quasistatic_ref.lab.study.problems.answers import (
    NONE,
    NotKnown,
    bounded_answer,
    cone_answer,
    exact_answer,
)
from quasistatic_ref.lab.study.problems.difficulty import measures, tags
from quasistatic_ref.lab.study.problems.families.cones import cone_rows
from quasistatic_ref.lab.study.problems.families.dials import DIALS, HARVESTED, one_turned
from quasistatic_ref.lab.study.problems.families.harvest import Count, no_count
from quasistatic_ref.lab.study.problems.families.made import Made
from quasistatic_ref.lab.study.problems.folder import (
    family_read,
    family_written,
    finished,
    set_written,
)
from quasistatic_ref.lab.study.problems.problem import QP, SOCP, SPARSE, Answer, Member
from quasistatic_ref.lab.study.problems.recipe import CONTACT_QP_1, Recipe, family_made
from quasistatic_ref.optional.large.sparse_form import Pattern, sparse_form
from quasistatic_ref.simulate.progress import progress_bar
from quasistatic_ref.solve.units import Units, coordinate_units, metric, units_from, units_of
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import standard_form

ATTEMPTS = 10
"""Draws of a problem, until it has a solution where its family has, and one that is not zero."""
UNKNOWN = Answer("", 0.0, NONE, NONE, NONE, NONE, {0: "1"})
"""In place of an answer that is still to be found."""


def made_set(recipe: Recipe, folder: Path, progress: bool = True) -> list[Path]:
    """Make a set and write its folder; families that are there are not made again.

    Parameters
    ----------
    recipe : Recipe
    folder : Path
    progress : bool

    Returns
    -------
    list of Path
        What was written, the manifest last.
    """
    total = sum(recipe.families.values())
    with progress_bar(total=total, unit="problem", words="exact answers", shown=progress) as bar:
        for family, count in recipe.families.items():
            if not finished(folder, family):
                members = list(family_members(family, count, recipe.seed))
                family_written(folder, family, members)
            bar.update(count)
    every = {family: family_read(folder, family) for family in recipe.families}
    return set_written(folder, recipe.name, every)


def family_members(
    family: str, count: int, seed: int, count_steps: Count = no_count
) -> Iterator[Member]:
    """The problems of one family with their answers.

    Steps of runs that move nothing are left out, but for those of sequences, and steps that are
    there already, in this family or in one of runs before it.

    Parameters
    ----------
    family : str
    count : int
    seed : int
    count_steps : callable
        Is called with the number of steps of scenarios that were just simulated.
    """
    if family in DIALS:
        for i, one in enumerate(family_made(family, count, seed, count_steps)):
            yield _good(one, i, seed)
        return
    seen: set[bytes] = set()
    for before in list(HARVESTED)[: list(HARVESTED).index(family)]:
        share = CONTACT_QP_1.families[before]
        seen |= {_digest(one) for one in family_made(before, share, seed, count_steps)}
    for one in family_made(family, count, seed, count_steps):
        if (digest := _digest(one)) in seen and one.sequence is None:
            continue
        seen.add(digest)
        found = member_of(one)
        if found.answer.x.any() or one.sequence is not None:
            yield found


def _digest(one: Made) -> bytes:
    """What tells the numbers of one step from those of another."""
    return hashlib.sha256(b"".join(v.tobytes() for v in standard_form(one.step))).digest()


def _good(one: Made, i: int, seed: int) -> Member:
    """The problem, or another in its place that has a solution if it should."""
    dial = DIALS[one.family]
    for again in range(ATTEMPTS):
        if again:
            assert one.dial is not None  # of every family in DIALS
            one = one_turned(one.family, one.dial, i, seed, again)
        try:
            found = member_of(one)
        except NotKnown:
            continue
        solved = not found.answer.farkas
        if solved == dial.solvable and (not solved or found.answer.x.any()):
            return found
    raise NotKnown(f"{one.id}: no draw is a problem of its family")


def member_of(one: Made) -> Member:
    """A problem of a set from a step, with its answer and what is measured of it.

    Raises
    ------
    NotKnown
        If its answer cannot be proved.
    """
    if SPARSE in one.tags:
        return _measured(one, *_sparse(one), kind=QP)
    if one.step.cone == "ellipsoid":
        form, _ = cone_rows(one.step)
        units = units_of(form, metric(form.H))
        parts = csr_matrix(form.H), form.g, csr_matrix(form.A), form.b, units
        return _measured(one, *parts, cone_answer(one.step, form), kind=SOCP)
    form = standard_form(one.step)
    units = units_of(form, metric(form.H))
    parts = csr_matrix(form.H), form.g, csr_matrix(form.A), form.b, units
    return _measured(one, *parts, exact_answer(form), kind=QP)


def _sparse(one: Made) -> tuple[csr_matrix, Array, csr_matrix, Array, Units, Answer]:
    """The numbers of a sparse step, and its answer."""
    from scipy.sparse.linalg import spsolve

    form = sparse_form(one.step, Pattern(one.step))
    H, A = csr_matrix(form.P + triu(form.P, 1).T), csr_matrix(form.A)
    S = coordinate_units(H.diagonal())
    rows = A.multiply(S)
    squares = np.sort(np.asarray(rows.multiply(rows).sum(axis=1)).ravel())
    energy = float(np.sqrt(form.g @ spsolve(csc_matrix(H), form.g)))
    units = units_from(S, squares, energy, form.b)
    plain = Member({}, H, form.g, A, form.b, units, UNKNOWN).natural
    answer = bounded_answer(plain.H, plain.g, plain.A, plain.b, units)
    return H, form.g, A, form.b, units, answer


def _measured(
    one: Made, H: csr_matrix, g: Array, A: csr_matrix, b: Array, units: Units, answer: Answer,
    kind: str,
) -> Member:  # fmt: skip
    """The member with its line: what it is, how hard it is, how its answer is known."""
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
        "sequence": None
        if one.sequence is None
        else {"name": one.sequence[0], "place": one.sequence[1]},
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
    member = Member(facts, H, g + 0.0, A, b + 0.0, units, answer)
    found = measures(member)
    facts |= {"tags": tags(member, one.tags, found), "measures": found}
    return replace(member, facts=facts)
