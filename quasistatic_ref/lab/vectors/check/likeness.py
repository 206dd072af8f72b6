"""Which formula failing cases point to: planted mistakes are known by the cases that they spoil.

``fingerprints.json.gz`` has mistakes of one place in the plain program, each with the committed
cases and the fields of their answers that it makes wrong (``validation/make/fingerprints.py``). A
mistake in another program's formula for the same thing makes nearly the same ones wrong, in
whatever way it is written. The likeness of two such sets is the share of their union that both
have (Jaccard).
"""

import gzip
import json
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from quasistatic_ref.lab.vectors.check.case import verdict_to_digits
from quasistatic_ref.lab.vectors.check.compare import (
    NO_NUMBERS,
    OPTIONAL,
    leaves,
    parts,
    tolerance_of,
)
from quasistatic_ref.lab.vectors.check.mistakes import Failed
from quasistatic_ref.lab.vectors.check.report import Likely
from quasistatic_ref.lab.vectors.check.verdict import FAILED
from quasistatic_ref.lab.vectors.expected import Json

LEAST = 0.3
"""Likeness below which nothing is said [-]."""
NEARLY = 0.8
"""A second formula is said if it is that nearly as like as the first [-]."""


@dataclass(frozen=True)
class Fingerprints:
    """Of planted mistakes, what each makes wrong.

    Parameters
    ----------
    bits : dict of str to int
        One bit for each case, and for each field of a case.
    mistakes : list of (subjects, place, int)
    """

    bits: dict[str, int]
    mistakes: list[tuple[tuple[str, ...], str, int]]


@cache
def fingerprints() -> Fingerprints:
    """Those that come along."""
    path = files("quasistatic_ref.lab.vectors.check") / "fingerprints.json.gz"
    found = json.loads(gzip.decompress(path.read_bytes()))
    bits = {name: 1 << i for i, name in enumerate(found["wrong"])}
    mistakes = [(tuple(one[0]), one[1], int(one[-1], 16)) for one in found["mistakes"]]
    return Fingerprints(bits, mistakes)


def likely(
    wrong: Collection[str], cases: Collection[str], unsaid: Collection[str] = ()
) -> tuple[Likely, ...]:
    """The one or two formulas whose mistakes are the most alike; none if all are too unlike.

    Parameters
    ----------
    wrong : collection of str
        As ``wrong_parts`` names it.
    cases : collection of str
        Ids of those that were judged.
    unsaid : collection of str
        Fields of them that were not answered, named in the same way.
    """
    known = fingerprints()
    layers = {name.partition("/")[0] for name in known.bits}
    spoiled = {name for name in wrong if name.partition("/")[0] in layers}
    if not spoiled:
        return ()
    own = sum(known.bits.get(name, 0) for name in spoiled)
    others = len(spoiled - known.bits.keys())
    asked = {*cases}
    aside = {*unsaid}
    seen = sum(
        bit
        for name, bit in known.bits.items()
        if name.partition(" ")[0] in asked and name not in aside
    )
    best: dict[str, Likely] = {}
    for subjects, place, planted in known.mistakes:
        theirs = planted & seen
        likeness = (own & theirs).bit_count() / ((own | theirs).bit_count() + others)
        for subject in subjects:
            if subject not in best or likeness > best[subject].likeness:
                best[subject] = Likely(subject, place, likeness)
    first, *rest = sorted(best.values(), key=lambda one: -one.likeness)
    if first.likeness < LEAST:
        return ()
    return first, *(one for one in rest[:1] if one.likeness >= NEARLY * first.likeness)


def wrong_parts(layer: str, one: Failed) -> Iterator[str]:
    """A case that fails: its id, and its id with each wrong field, or with none without an output.

    Parameters
    ----------
    layer : str
    one : Failed
        Of verdict FAILED or MISSING.
    """
    yield one.id
    fields = {""}
    if one.output is not None:
        fields = wrong_fields(layer, one.case, one.record, one.output) or {one.verdict.field}
    yield from (f"{one.id} {field}" for field in fields)


def wrong_fields(layer: str, case: Json, record: Json, output: Json) -> set[str]:
    """The fields of an output that are wrong; where many are right, nothing is said of them."""
    flags = record["flags"]
    free = {*NO_NUMBERS}
    free |= set() if flags.get("unique_multipliers", True) else {"lam", "wrench"}
    free |= set() if flags.get("unique", True) else {"alpha", "beta", "n"}
    if not isinstance(output, dict):
        return set()
    given = parts(output)
    found = set()
    for name, value in parts(record["output"]).items():
        if name in free or (name not in given and name in OPTIONAL.get(layer, ())):
            continue
        if name not in given:
            found.add(name)
        elif name == "farkas":
            proof = {**record["output"], name: given[name]}
            proof.pop("certificate", None)
            proved = verdict_to_digits(layer, case, record, proof, None).verdict != FAILED
            found |= set() if proved else {name}
        elif not _is_same(value, given[name], tolerance_of(record["tolerance"], name)):
            found.add(name)
    return found


def _is_same(value: Json, other: Json, tolerance: float) -> bool:
    """Whether all numbers are within a tolerance, and all else is equal."""
    try:
        one, two = (np.array(_flat(v), dtype=np.float64) for v in (value, other))
    except (TypeError, ValueError, OverflowError):
        return bool(value == other)
    return one.shape == two.shape and bool(np.all(np.abs(one - two) <= tolerance))


def _flat(value: Any) -> Any:
    return [v for _, v in leaves(value)] if isinstance(value, dict) else value
