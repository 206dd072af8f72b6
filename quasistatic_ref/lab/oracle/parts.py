"""Which parts of scenes another program moves wrongly, and what these alone have: the layer.

Coordinates that neither H nor a contact couples are parts: each moves as if it were alone. Of many
parts, in several scenes, one mistake spoils some. Said is what nearly all of those have, and nearly
no other part: a pair of shapes, a kind of joint, a cone. A part whose program ends at once is
wrong, whatever it has.
"""

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np

from quasistatic_ref.certify.norm import energy_norm, relative_digits
from quasistatic_ref.lab.oracle.words import Words, contact_words, side_words
from quasistatic_ref.lab.program.mechanism import kinematics
from quasistatic_ref.lab.program.step import pose_in_world
from quasistatic_ref.lab.vectors.converters import places
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.groups import groups
from quasistatic_ref.step.standard_form import standard_form

LAYERS = {
    "shape": "distance", "pair": "distance", "meeting": "distance",
    "k above 1": "selection", "joint under the contact": "jacobian",
    "a mimic under the contact": "jacobian",
    "a placement under the contact": "jacobian", "rows": "rows",
}  # fmt: skip
"""By the kind of a contact's word, the layer in which what it says is computed."""
ORDER = ("distance", "selection", "jacobian", "rows", "integrate", "step")
"""Of layers that explain as much, the first is said: in the later ones its mistake shows, too."""
MISSED = 3
"""What a wrong part that is not explained costs, in right ones of which the same is true [-]."""
FURTHER = 2
"""What a second word costs, in the same [-]."""
NOTHING = 1e-9
"""How far a part may be off, over the largest displacement of its step [-]."""
REST = 0.2
"""Share of the wrong parts that a further explanation has to explain."""
SAID = 3
"""Explanations at most."""


class Part(NamedTuple):
    """Coordinates that move by themselves.

    Parameters
    ----------
    fails : bool
    words : set of str
        What it has, each word behind its layer: where it first fails, or in all steps.
    """

    fails: bool
    words: Words


class Moved(NamedTuple):
    """A step of the other program, and the reference's from the same state.

    Parameters
    ----------
    case : dict
        As an input of the layer ``step``.
    result : StepResult
    off : ndarray, shape (n_v,)
        Where it ended less where the reference does [m, rad].
    """

    case: Json
    result: StepResult
    off: Array

    @property
    def frames(self) -> Json:
        """(R, t) of each body, and more, before the step."""
        return kinematics(self.case["mechanism"], np.array(self.case["q"]))


class Diagnosis(NamedTuple):
    """The layer, and what the wrong parts have.

    Parameters
    ----------
    layer : str
    words : set of str
        One of which nearly all of them have, and nearly no right one.
    sentence : str
    """

    layer: str
    words: Words
    sentence: str


def parts_of(steps: Sequence[Moved], digits: float, least: float) -> tuple[Part, ...]:
    """The parts of a scene.

    Parameters
    ----------
    steps : sequence of Moved
        In the order of their time.
    digits : float
        Of a part that counts as right [-].
    least : float
        What counts as rounding [m, rad].
    """
    found: dict[tuple[int, ...], Part] = {}
    for one in steps:
        form = standard_form(one.result.step)
        frames = one.frames
        small = max(least, NOTHING * np.abs(one.result.solution.delta_q).max(initial=0.0))
        for group in groups(one.result.step):
            mine = group.coordinates[group.coordinates < len(one.off)]  # without an extension's
            if not len(mine):
                continue
            norm = energy_norm(form.H[np.ix_(mine, mine)])
            off = one.off[mine]
            right = relative_digits(norm.of_displacement(off), norm.of_impulse(form.g[mine]))
            fails = bool(right < digits and np.abs(off).max() > small)
            before = found.get(tuple(mine), Part(False, frozenset()))
            if not before.fails:
                words = frozenset(_words(one, frames, {*mine.tolist()}, fails))
                both = words if fails else words | before.words
                found[tuple(mine)] = Part(fails, both)
    return tuple(found.values())


def ended(case: Json, result: StepResult) -> Part:
    """A scene of which another program takes no step, as one part."""
    every = Moved(case, result, np.zeros(result.step.n_v))
    return Part(True, frozenset(_words(every, every.frames, {*range(result.step.n_v)}, True)))


def _words(one: Moved, frames: Json, mine: set[int], fails: bool) -> Iterator[str]:
    """What a part has in a step: its joints, and the contacts that press."""
    for body, _, v in places(one.case["mechanism"]):
        if mine.isdisjoint(range(v.start, v.stop)):
            continue
        kind = body["joint"]
        yield f"integrate: joint: {kind}"
        if body.get("actuated"):
            yield f"step: actuated joint: {kind}"
        else:
            yield f"step: un-actuated joint: {kind}"
            yield from ("jacobian: kinematics", f"jacobian: kinematics of joint: {kind}")
    contacts = one.result.step.contacts
    own = [j for j in range(contacts.n_c) if np.any(contacts.J[j][:, sorted(mine)])]
    pressing = [j for j in own if one.result.solution.wrench[j, 2] > 0]
    for j in pressing or (own if fails else []):
        yield from _contact_words(one, frames, j)


def _contact_words(one: Moved, frames: Json, j: int) -> Iterator[str]:
    """What a contact has."""
    case = one.case
    contacts = one.result.step.contacts
    n = contacts.n[j]
    phi = float(contacts.phi[j])
    name = contacts.name[j]
    pair = next(p for p in case["pairs"] if name.rpartition("/")[0] == p["name"])
    sides = [case["shapes"][pair[side]] for side in ("alpha", "beta")]
    shapes = [side["shape"] for side in sides]
    words = contact_words(case, {"phi": phi}, pair)
    words |= side_words(shapes, [pose_in_world(side, frames) for side in sides], phi, n)
    for word in words:
        kind, _, value = word.rpartition(": ")
        layer = LAYERS.get(kind or word)
        if layer is None or value == "fixed":
            continue
        yield f"{layer}: {word}"
        if layer == "jacobian" and kind:
            yield f"jacobian: kinematics of joint: {value}"
    yield from ("jacobian: kinematics", "jacobian: a contact")
    yield f"rows: cone: {case['cone'].partition('-')[0]}"
    if case["cone"] != "frictionless" and (pair["mu_v"] or pair["mu_omega"]):
        yield "rows: friction"
        yield f"step: friction, least entry of n: {'xyz'[int(np.abs(n).argmin())]}"


def diagnosis(parts: Sequence[Part]) -> Diagnosis | None:
    """What tells wrong parts from right ones; None without both."""
    wrong = [part.words for part in parts if part.fails]
    right = [part.words for part in parts if not part.fails]
    if not wrong or not right:
        return None
    known = sorted(frozenset().union(*wrong))
    alike = [two for two in combinations(known, 2) if _kind(two[0]) == _kind(two[1])]
    tried = [frozenset(words) for words in (*((word,) for word in known), *alike)]
    left = wrong
    said: list[Words] = []

    def cost(words: Words) -> tuple[float, int, str]:
        missed = sum(map(words.isdisjoint, left))
        spoiled = _count(words, right)
        first = min(words)
        layer = ORDER.index(first.partition(": ")[0])
        return MISSED * missed + spoiled + FURTHER * (len(words) - 1), layer, first

    while left and len(said) < SAID:
        best = min(tried, key=cost)
        if said and _count(best, left) < REST * len(wrong):
            break
        said.append(best)
        left = [words for words in left if best.isdisjoint(words)]
    layers = [min(words).partition(": ")[0] for words in said]
    layer = min(layers, key=ORDER.index)
    words = said[layers.index(layer)]
    what = _kind(min(words)).partition(": ")[2]
    values = sorted(word.rpartition(": ")[2] for word in words)
    plain = frozenset(word.partition(": ")[2] for word in words)
    what = f"{what} {' or '.join(values)}".strip()
    return Diagnosis(
        layer,
        plain,
        f"parts with {what} are wrong, {_count(words, wrong)} of {len(wrong)} wrong parts, "
        f"and {_count(words, right)} of {len(right)} right ones have that",
    )


def _kind(word: str) -> str:
    """Layer and kind of a word; the layer of one that is of no kind."""
    return word.rpartition(": ")[0]


def _count(words: Words, parts: Sequence[Words]) -> int:
    """Of how many parts one of the words is true."""
    return sum(not words.isdisjoint(part) for part in parts)
