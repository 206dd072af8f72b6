"""Steps whose exact optima are stored, and what the prover of a library makes of them.

The steps have ties, groups, rows of a user's own and numbers of very different size, and some have
no solution. ``validation/make/known_steps.py`` makes the file from the core's exact method.
"""

import gzip
import json
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Literal, NamedTuple, TypedDict

import numpy as np

from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.optional.fast.compiled.certificate import (
    DECIDED,
    NOT_POSED,
    REFUTED,
    GroupProof,
    Prover,
)
from quasistatic_ref.optional.fast.compiled.known_functions import MarkedArray
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.solve.units import DenseStepInBothUnits
from quasistatic_ref.step.data import Array, Indices, StepData
from quasistatic_ref.step.files import step_from_record
from quasistatic_ref.step.groups import Group, group_steps

FILE = Path(__file__).parent / "known_steps.jsonl.gz"

WRITTEN = ("delta_q", "lam", "net", "slack", "rest", "bound", "least", "claims")
"""Arrays that the library writes, of a step and of each group; and others of a group."""
OF_GROUP = ("guess", "answer", "idle", "still", "counts")
READ = (
    "cone", "K_q", "M_u", "coordinate", "hessian_values", "delta_q_bar_a", "tau", "phi", "frame",
    "J", "mu",
)  # fmt: skip
"""Arrays of a group behind which stands no number."""
OF_FORCES = ("face", "compliance", "wrench")
"""Arrays that the library writes of the forces of a group."""
RIGHT = "right"
"""The guess that is the working set of the stored optimum."""


Field = Literal["delta_q", "net", "slack", "lam"]


class Stored(TypedDict):
    """The optimum of a step.

    Parameters
    ----------
    delta_q, net, slack, lam : list of float
        Of its ExactOptimum [as there].
    working_set : list of int
    rest : list of float
        What rounding took from delta_q, rounded [m, rad].
    degeneracy : list of list of bool
        Of each group: whether its multipliers are unique and its displacement differentiable.
    """

    delta_q: list[float]
    rest: list[float]
    net: list[float]
    slack: list[float]
    lam: list[float]
    working_set: list[int]
    degeneracy: list[list[bool]]


class Known(NamedTuple):
    """A step, and what is known of it.

    Parameters
    ----------
    step : StepData
    optimum : dict or None
        None of a step without solution.
    outcomes : str
        What proofs on each of the :func:`guesses` come to, a letter for each group, as the library
        that made the file had it: ``o`` for an optimum, ``r`` for a guess that is refuted, ``-``
        for neither.
    digits : list of int
        How many digits modulo p each of these proofs found, which the bound of zeros.c tells.
    """

    step: StepData
    optimum: Stored | None
    outcomes: str
    digits: list[int]


@cache
def known_steps() -> list[Known]:
    """The stored steps."""
    with gzip.open(FILE, "rt", encoding="utf-8") as lines:
        records = [json.loads(line) for line in lines]
    return [
        Known(
            step_from_record(one["step"]),
            **{name: one.get(name) for name in ("optimum", "outcomes", "digits")},
        )
        for one in records
    ]


def guesses(step: StepData, optimum: Stored | None) -> dict[str, Array]:
    """Multipliers of answers that guess some rows, each of shape (m,): only the first is right.

    A working set has no row to spare: without one of its rows, its minimiser is another. Nor is the
    optimum the minimiser on rows of which one has a slack there; and a row that bears nothing
    belongs to no working set.
    """
    pressed = np.zeros(step.m)
    if optimum is None:
        pressed[:1] = 1.0
        return {"of its first row": pressed}
    working = np.array(optimum["working_set"], dtype=np.int64)
    pressed[working] = 1.0
    found = {RIGHT: pressed}
    if len(working):
        found["without its last row"] = pressed.copy()
        found["without its last row"][working[-1]] = 0.0
    loose = np.flatnonzero(optimum["slack"])
    if len(loose):
        found["with a row that has a slack"] = pressed.copy()
        found["with a row that has a slack"][loose[0]] = 1.0
    idle = np.setdiff1d(np.flatnonzero(np.array(optimum["slack"]) == 0.0), working)
    if len(idle):
        found["with a row that bears nothing"] = pressed.copy()
        found["with a row that bears nothing"][idle[-1]] = 1.0
    return found


class Tried(NamedTuple):
    """What one proof has come to.

    Parameters
    ----------
    group : Group
    number : int
        Of the group among those of the step.
    guess : str
        Its words.
    changed : bool
        Whether the guess differs from the right one in rows of this group.
    code : int
        The outcome, as in proof.h.
    digits : int
        As of Known.
    found : ExactOptimum or None
    whole : ExactOptimum or None
        Of the step, where all groups are proved on what the guess leads to.
    rest : ndarray, shape (2, n_v)
        What rounding took from its delta_q, and a bound of more [m, rad].
    units : ndarray, shape (2,), or None
        Natural length and size that the library found [m per (N m s)^0.5, (N m s)^0.5]; None where
        it did not pose the step.
    of : DenseStepInBothUnits
        The step of the group.
    inside : bool
        Whether nothing was written behind the arrays of a step and its groups.
    """

    group: Group
    number: int
    guess: str
    changed: bool
    code: int
    digits: int
    found: ExactOptimum | None
    whole: ExactOptimum | None
    rest: Array
    units: Array | None
    of: DenseStepInBothUnits
    inside: bool


def marks_behind(s: Structure, names: Sequence[str]) -> list[MarkedArray]:
    """Arrays of a structure, each of which has marks behind it from now on."""
    found = []
    for name in names:
        array = MarkedArray(s[name].size, float if s[name].dtype == np.float64 else int)
        array.all[: array.size] = s[name].ravel()
        s.put({name: array.all[: array.size]})
        found.append(array)
    return found


def end_what_is_read(s: Structure) -> None:
    """Put what is no number behind each array of a group that the library reads."""
    for array in marks_behind(s, READ):
        array.all[array.size :] = np.nan


def tried(known: Known) -> Iterator[Tried]:
    """All proofs of the groups of a step, on all guesses, by the library of this process."""
    step = known.step
    divided = [(group, DenseStepInBothUnits(own)) for group, own in group_steps(step)]
    both = DenseStepInBothUnits(step)
    prover = Prover(both, [(group, own.si_step, own.hessian) for group, own in divided])
    arrays = marks_behind(prover.s, WRITTEN)
    for each in prover.proofs:
        if each is None:
            continue
        arrays += marks_behind(each.s, (*WRITTEN, *OF_GROUP))
        end_what_is_read(each.s)
    every = guesses(step, known.optimum)
    right = every.get(RIGHT, np.full(step.m, -1.0))
    for words, lam in every.items():
        whole = prover.optimum(both, lam, np.where(lam > 0.0, 0.0, 1.0))
        rest = np.array(prover.displacement()[1:])
        for number, (group, own) in enumerate(divided):
            proof = prover.proofs[number]
            changed = bool((lam != right)[group.rows].any())
            found = None
            units = None
            code = NOT_POSED
            digits = 0
            if isinstance(proof, GroupProof) and proof.code != NOT_POSED:
                guess: Indices = np.flatnonzero(lam[group.rows])
                units = proof.s["units"].copy()
                found = proof.on(guess, own.units)
                code = proof.code
                digits = int(proof.s.integers("counts")[2])
            inside = all(array.kept for array in arrays)
            yield Tried(
                group, number, words, changed, code, digits, found, whole, rest, units, own, inside
            )


def letter(code: int) -> str:
    """How the outcome of a proof is stored."""
    return {DECIDED: "o", REFUTED: "r"}.get(code, "-")


def wrong(known: Known) -> str | None:
    """What a library makes of a step that is wrong, in words; None if all is right."""
    for i, one in enumerate(tried(known)):
        if one.units is not None and one.units.tolist() != [*one.of.units[1:]]:
            return f"its natural units are {one.units.tolist()} in place of {one.of.units[1:]}"
        if not one.inside:
            return "something is written behind an array"
        if letter(one.code) != known.outcomes[i]:
            return f"a guess {one.guess} is decided otherwise"
        if one.digits != known.digits[i]:
            return f"a guess {one.guess} takes {one.digits} digits in place of {known.digits[i]}"
        if one.code == REFUTED and not one.changed:
            return "the right guess is refuted"
        optimum = known.optimum
        if one.whole is not None:
            if optimum is None or not same(one.whole, optimum, one.guess == RIGHT):
                return f"the optimum that a guess {one.guess} leads to is wrong"
            if not enclosed(one.rest, optimum):
                return "what rounding took from a displacement is wrong"
        if one.found is None:
            continue
        if one.changed or optimum is None:
            return f"a guess {one.guess} is proved"
        unlike = different(one, optimum)
        if unlike:
            return f"{unlike} of an optimum is wrong"
    return None


def different(one: Tried, optimum: Stored) -> str | None:
    """The first field of an optimum, proved on the right guess, that is not the stored one's."""
    found = one.found
    assert found is not None
    rows = one.group.rows
    coordinates = one.group.coordinates
    places: dict[Field, Indices] = {
        "delta_q": coordinates, "net": coordinates, "lam": rows, "slack": rows,
    }  # fmt: skip
    for name, at in places.items():
        right = np.array(optimum[name], dtype=np.float64)[at]
        if getattr(found, name).tobytes() != right.tobytes():
            return name
    lam = found.lam[list(found.working_set)].tolist()
    if found.smallest_active_multiplier != min(lam, default=None):
        return "the smallest multiplier"
    slack = found.slack[found.slack > 0].tolist()
    if found.smallest_inactive_slack != (min(slack, default=None) if found.differentiable else 0.0):
        return "the smallest slack"
    degeneracy = [found.multipliers_unique, found.differentiable]
    return None if degeneracy == optimum["degeneracy"][one.number] else "degeneracy"


def same(found: ExactOptimum, optimum: Stored, on_right: bool) -> bool:
    """Whether the optimum of a step is the stored one: of multipliers only on the right guess."""
    degeneracy = optimum["degeneracy"]
    slack = found.slack[found.slack > 0].tolist()
    least = min(slack, default=None) if found.differentiable else 0.0
    claims = [found.multipliers_unique, found.differentiable, found.smallest_inactive_slack]
    lam = found.lam[found.lam > 0].tolist()
    names: list[Field] = ["delta_q", "net", "slack"]
    if on_right:
        names.append("lam")
    return (
        all(
            getattr(found, name).tobytes() == np.array(optimum[name], dtype=np.float64).tobytes()
            for name in names
        )
        and claims == [*map(all, zip(*degeneracy, strict=True)), least]
        and found.smallest_active_multiplier == min(lam, default=None)
    )


def enclosed(rest: Array, optimum: Stored) -> bool:
    """Whether the stored rest of delta_q lies in the bounds of another, which are narrow.

    Parameters
    ----------
    rest : ndarray, shape (2, n_v)
        What rounding took from delta_q, and a bound of more [m, rad].
    optimum : dict
    """
    right = np.array(optimum["rest"], dtype=np.float64)
    found, bound = rest
    near = abs(found - right) <= bound
    unit = np.spacing(abs(np.array(optimum["delta_q"], dtype=np.float64)))
    return bool((near & (bound >= abs(right) * 2.0**-51) & (bound <= unit * 2.0**-50)).all())


def numbers(found: ExactOptimum) -> list[float]:
    """Displacements and slacks of an optimum [m, rad]."""
    return [*found.delta_q.tolist(), *found.slack.tolist()]


def stale(known: Known) -> str | None:
    """What of other data a library takes for that of a step, in words; None if nothing.

    The same object proves a step in which one kind of data differs, as a new object does, and then
    the step itself.
    """
    step = known.step
    in_both_units = [(group, DenseStepInBothUnits(own)) for group, own in group_steps(step)]
    divided = [(group, own.si_step, own.hessian) for group, own in in_both_units]
    both = DenseStepInBothUnits(step)
    optimum = known.optimum
    if optimum is None:
        return None
    lam = guesses(step, optimum)[RIGHT]
    contacts = step.contacts
    if Prover(both, divided).optimum(both, lam, np.zeros(step.m)) is None:
        return None
    unique = all(each for each, _ in optimum["degeneracy"])
    prover = Prover(both, divided)
    pushed = np.linspace(1.0, 2.0, step.n_v)
    others = {
        "a target": step.replace(delta_q_bar_a=step.delta_q_bar_a + pushed[: step.n_a]),
        "a load": step.replace(tau_a=step.tau_a + pushed[: step.n_a]),
        "a weight": step.replace(tau_u=step.tau_u + pushed[step.n_a :]),
        "a gap": step.replace(contacts=replace(contacts, phi=contacts.phi + 2.0**-10)),
        "a tangent": step.replace(contacts=replace(contacts, d1=contacts.d2, d2=-contacts.d1)),
        "a normal": step.replace(contacts=replace(contacts, n=-contacts.n, d1=-contacts.d1)),
        "a Jacobian": step.replace(contacts=replace(contacts, J=2 * contacts.J)),
        "a friction": step.replace(contacts=replace(contacts, mu_v=2 * contacts.mu_v)),
    }
    others["a number"] = step.replace(
        delta_q_bar_a=others["a target"].delta_q_bar_a,
        tau_a=others["a load"].tau_a,
        tau_u=others["a weight"].tau_u,
        contacts=replace(contacts, phi=contacts.phi + 2.0**-10, J=2 * contacts.J),
    )
    for words, other in others.items():
        in_units = DenseStepInBothUnits(other)
        provers = prover, Prover(in_units, divided)
        one, two = (each.optimum(in_units, lam, np.zeros(step.m)) for each in provers)
        found = prover.optimum(both, lam, np.zeros(step.m))
        as_new = two is None or (one is not None and numbers(one) == numbers(two))
        if not as_new or found is None or not same(found, optimum, unique):
            return f"{words} of another step is taken for its own"
    return None
