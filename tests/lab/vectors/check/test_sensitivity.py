"""Any one number changed beyond its tolerance is found."""

import pytest

from quasistatic_ref.lab.vectors.check.compare import ROUNDING
from quasistatic_ref.lab.vectors.trees import nodes
from tests.cases import first
from tests.lab.vectors.committed_cases import (
    LAYERS,
    cases,
    expected_of,
    right_answers,
    verdict_of,
)
from tests.oracles.records import with_value


def numbers_in(value):
    """Every number of an output, with the keys and indices that lead to it."""
    return [(path, leaf) for path, leaf in nodes(value) if isinstance(leaf, int | float)]


@pytest.mark.parametrize("layer", LAYERS)
def test_no_tolerance_passes_anything_or_nothing(layer):
    """At most 1e-5 of what a field holds, or of one; 0 only of copies and of sums of zeros."""
    for name, record in expected_of(layer).items():
        for field, tolerance in record["tolerance"].items():
            outer, _, inner = field.partition(".")
            value = record["output"][outer]
            within = [contact[inner] for contact in value] if inner else [value]
            sizes = [abs(v) for _, v in numbers_in(within)]
            assert tolerance["absolute"] <= 1e-5 * max([1.0, *sizes]), (name, field)
            copied = field in ("b", "indices") or not sizes
            zeros = layer in ("rows", "wrench") and not any(sizes)
            assert tolerance["absolute"] > 0 or copied or zeros, (name, field)


@pytest.mark.parametrize("every", first(1, [16, 1]))
@pytest.mark.parametrize("layer", LAYERS)
def test_any_one_number_changed_beyond_its_tolerance_fails(layer, every, rng):
    """Three numbers of every case, each by two tolerances.

    By a thousandth of its field where it may be another one.
    """
    answers = right_answers(layer)
    tried = 0
    for case in cases(layer)[::every]:
        wanted = expected_of(layer)[case.id]
        answer = answers[case.id]
        found = numbers_in(answer)
        for i in rng.permutation(len(found))[:3]:
            keys, value = found[i]
            by = change_of(layer, case.input, wanted, keys)
            if by is None:
                continue
            other = with_value(answer, keys, value + (1 if rng.random() < 0.5 else -1) * by)
            verdict = verdict_of(layer, case.input, wanted, other)
            assert verdict.verdict == "failed", (case.id, keys, value, by, verdict)
            tried += 1
    assert tried >= len(cases(layer)) / every


def change_of(layer, case, wanted, keys):
    """By how much a number is changed; None where no change of it can be wrong."""
    field = keys[0]
    inner = keys[2] if field == "contacts" else field
    name = f"contacts.{inner}" if field == "contacts" else field
    tolerance = wanted["tolerance"].get(name, {"absolute": 0.0})["absolute"]
    output = wanted["output"]
    within = [c[inner] for c in output[field]] if field == "contacts" else [output[field]]
    size = max(abs(v) for _, v in numbers_in(within))
    if inner == "indices":  # of a group that is tied, the next may be as good
        return 10**6 if wanted["flags"]["tie"] else 1
    if inner == "index":
        return 1
    if field == "farkas":
        return 1e-3
    free = (layer == "distance" and not wanted["flags"]["unique"] and field != "phi") or (
        field in ("lam", "wrench") and not wanted["flags"].get("unique_multipliers", True)
    )
    if free and field == "lam":
        A = case.get("A") or output.get("A") or [r for b in case["second_order"] for r in b["F"]]
        if not any(A[keys[1]]):
            return None  # a row of zeros: its multiplier does nothing
    return max(2 * tolerance, 1e-3 * max(size, 0.01) if free else 0.0, 2 * ROUNDING * size, 5e-324)
