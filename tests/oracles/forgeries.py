"""Every field of every kind of solution file, forged.

Good files of each kind of certificate in the pyramid and in the ellipsoid, and of an infeasible
step, are spoilt one field at a time. The fields are those that stand in the file: one
that is added to the format is attacked without a line here. Each number is moved by one unit in
the last place, in both directions, and replaced by nonsense; each word, truth, fraction, row and
list is replaced, left out, lengthened; fields are added. Multipliers are forged with the wrenches
that go with them, too, and up to three numbers at random.

A forged file must be refused, or still be true: a bound may be larger than it need be, and where a
bound is all that is claimed of numbers they may move within it. What is true is decided by
fractions, from the equations (``solution_truth.py``): ``verify`` and its code give the optimum
alone.
"""

import json
import math

import numpy as np

from quasistatic_ref import InputError, load_solution, verify
from tests.oracles.records import places, value_at, with_value
from tests.oracles.solution_truth import solution_file, truth_of, wrenches

NO_NUMBER = (None, "1", True, [], {}, [0.0], math.nan, math.inf, -math.inf)
HUGE = (1e308, -1e308, 1e9, -1.0, 5.0)
NO_WORD = (None, 1, True, [], {}, "", "x", "residual", "exact", "infeasible")
NO_FRACTION = (None, 1, 0.5, [], "", "0.5", "1e9", "nan", "1/0", "-1", "1/3", "7")
NO_LIST = (None, 0.0, "x", True, {})
RANDOM = 40
"""Forgeries of several fields."""


def good_file(step, kind):
    """The solution file of a step, certified as its kind wants."""
    certify = {"residual": "residual", "none": "off"}.get(kind.split()[0], "full")
    return json.loads(solution_file(step, certify=certify))


def replacements(value):
    """What may be put in the place of a value."""
    if isinstance(value, bool) or value is None:
        yield from (not value, int(bool(value)), "true", [], 0.5, -1.0)
    elif isinstance(value, int):
        yield from (value + 1, value - 1, -value, 10**30, value + 0.5, *NO_NUMBER)
    elif isinstance(value, float):
        yield from (math.nextafter(value, math.inf), math.nextafter(value, -math.inf))
        yield from (-value, value / 2, value * (1 - 1e-9), 0.0, 5e-324, *HUGE, *NO_NUMBER)
    elif isinstance(value, str) and value.replace("/", "").isdigit():
        p, _, q = value.partition("/")
        yield from (f"{int(p) + 1}/{q or 1}", f"{int(p) - 1}/{q or 1}", *NO_FRACTION)
    elif isinstance(value, str):
        yield from (value[:-1], f"{value}x", value[:-1] + "0", value.upper(), *NO_WORD)
    elif isinstance(value, list):
        yield from ([], [value], value[:-1], value[::-1], value * 2, *NO_LIST)
        yield from ([*value, extra] for extra in (*value[-1:], 0.0, [0, 0], None))
    else:
        yield from (dict(value, note=1), dict(value, gap=0.0), dict(value, residuals={}), *NO_LIST)


def with_its_wrenches(step, record):
    """A record whose wrenches are those of its multipliers, where that can be."""
    try:
        return dict(record, wrench=wrenches(step, record["lam"]))
    except (ArithmeticError, LookupError, TypeError, ValueError):
        return record


def forgeries(step, record):
    """Every forged record that differs from the good one, with the field that is forged."""
    for where in ((), *places(record)):
        value = value_at(record, where)
        name = ".".join(key for key in where if isinstance(key, str)) or "the file"
        for new in (*replacements(value), *([...] if where else [])):
            if new is value or (type(new) is type(value) and repr(new) == repr(value)):
                continue
            forged = with_value(record, where, new)
            yield name, forged
            if where[0:1] == ("lam",) and isinstance(new, float):
                yield f"{name} and wrench", with_its_wrenches(step, forged)
    rng = np.random.default_rng(1)
    for forged in (at_random(rng, step, record) for _ in range(RANDOM)):
        if forged != record:
            yield "some at random", forged


def reason(step, record, path):
    """Why a record is refused, by its reader or by `verify`; None where it is not."""
    path.write_text(json.dumps(record))
    try:
        return verify(load_solution(path, step)).reason or None
    except InputError as error:
        return str(error)


def outcomes(step, good, path, every=1):
    """Each forged record, or one of so many, with its field, and what came of it.

    That is ``"refused"``, ``"still true"`` or ``"PASSED"``.
    """
    truth = truth_of(step, good)
    for number, (name, forged) in enumerate(forgeries(step, good)):
        if number % every and name != "some at random":
            continue
        if reason(step, forged, path):
            yield name, "refused", forged
        else:
            yield name, "still true" if truth(forged) else "PASSED", forged


def at_random(rng, step, record):
    """A record with up to three values taken from elsewhere in it, or moved by any power of ten."""
    leaves = [
        where for where in places(record) if not isinstance(value_at(record, where), dict | list)
    ]
    forged = record
    for _ in range(int(rng.integers(1, 4))):
        where = leaves[rng.integers(len(leaves))]
        value = value_at(record, leaves[rng.integers(len(leaves))])
        if isinstance(old := value_at(forged, where), float) and rng.random() < 0.7:
            value = old + (abs(old) + 1e-12) * float(
                10 ** rng.uniform(-17, 3) * rng.choice([-1, 1])
            )
        forged = with_value(forged, where, value)
    return with_its_wrenches(step, forged) if rng.random() < 0.5 else forged
