"""Random programs of all kinds against another method in fractions, with both checkers."""

import json
from collections import Counter

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.exact.qp.program import FIELDS, program_of
from tests.oracles.program_truth import refutation
from tests.oracles.random_programs import program_of_any_kind
from validation import check_solution as checker

PARTS = range(32)
IN_PART = 125
SHORT = [k if k < 4 else pytest.param(k, marks=pytest.mark.long) for k in PARTS]
NUMBERS = ("x", "z", "y", "z_box", "obj")


def answer_of(program):
    """The optimum of a program, or the proof that there is none."""
    arrays = [program[name] for name in FIELDS]
    try:
        return qr.exact_qp(program_of(*arrays, constant=program["constant"]))
    except (qr.QPInfeasible, qr.QPUnbounded, qr.QPNotConvex) as proof:
        return proof


def said(path):
    """What the checker in one file says of each claim."""
    return [*checker.program_verdicts(checker.program_read(checker.table(path)))]


def forged(path, rng):
    """Change one number of a saved optimum by a unit in the last place; its name."""
    record = json.loads(path.read_text())
    name = str(rng.choice([name for name in NUMBERS if record[name] != []]))
    numbers = np.atleast_1d(record[name])
    i = rng.integers(len(numbers))
    numbers[i] = np.nextafter(numbers[i], rng.choice([-np.inf, np.inf]))
    record[name] = numbers.tolist() if name != "obj" else numbers[0]
    path.write_text(json.dumps(record))
    return name


@pytest.mark.shared
@pytest.mark.filterwarnings("ignore:.* is a number here")  # programs of any scale
@pytest.mark.parametrize("part", SHORT)
def test_4000_programs_have_the_answers_of_another_method_in_fractions(part, tmp_path):
    """Both checkers take the file of each, and refuse a number that is off by an ulp."""
    kinds = Counter()
    path = tmp_path / "answer.json"
    for seed in range(IN_PART * part, IN_PART * (part + 1)):
        program = program_of_any_kind(seed)
        answer = answer_of(program)
        optimal = isinstance(answer, qr.ExactQP)
        if not isinstance(answer, qr.QPNotConvex):
            assert refutation(answer if optimal else None, program) is None, seed
        read = qr.load_answer(answer.save(path))
        verdict = qr.verify(read)
        assert verdict, (seed, verdict.reason)
        assert all(holds for _, holds in said(path)), seed
        kinds[type(answer).__name__] += 1
        if optimal:
            assert read == answer
            kinds["several"] += not answer.x_unique
            assert answer.digits(answer.x) > 15, seed
            if not answer.x_unique:  # what rounding of the multipliers leaves: 13.6 at the least
                assert answer.digits_of_multipliers(answer.z, answer.y, answer.z_box) > 13, seed
            name = forged(path, np.random.default_rng(seed))
            assert not qr.verify(qr.load_answer(path)), (seed, name)
            assert name == "obj" or not all(holds for _, holds in said(path)), (seed, name)
    assert len(kinds) >= 4, kinds
