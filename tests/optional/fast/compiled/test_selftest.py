"""The test that a compiled library has to pass: it finds what compilers do to bits."""

import json
import subprocess
import sys
from collections import Counter
from fractions import Fraction

import pytest

from quasistatic_ref import StepInfeasible
from quasistatic_ref.certify.exact import group_optimum, joined_optimum
from quasistatic_ref.certify.minimiser import rational_solution
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.formats.files import json_text
from quasistatic_ref.optional.fast.compiled.known_steps import Known, known_steps, tried
from quasistatic_ref.step.groups import group_steps
from tests.optional.fast.compiled.test_fast import needs_compiler
from tests.oracles.rows_given import P, small_numbers
from validation.make.prover_mutants import FLAGS, SAMPLE, WRONG_COMPILERS
from validation.tools.scripts import ROOT

pytestmark = needs_compiler


@pytest.fixture(scope="module")
def said():
    """What the test says with each compiler; in a process that has no library yet."""
    script = [sys.executable, "-m", "validation.make.prover_mutants", "--compilers"]
    done = subprocess.run(script, cwd=ROOT, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


@pytest.mark.parametrize("flags", [name for name in SAMPLE if name in FLAGS])
def test_a_library_of_which_float64_is_wrong_is_refused(said, flags):
    changed = f"its arithmetic is not that of float64: {FLAGS[flags]}"
    assert said[flags].startswith(changed)


@pytest.mark.parametrize("name", [name for name in SAMPLE if name in WRONG_COMPILERS])
def test_a_compiler_that_gets_an_operation_of_the_proofs_wrong_is_refused(said, name):
    """Its float64 is right: proofs are integers."""
    assert said[name].startswith(("a sum of products has the digits", "its proofs are wrong"))


def optimum_of(step):
    """The exact optimum as it is stored; None of a step without solution."""
    divided = group_steps(step)
    try:
        optima = [group_optimum(step, group, own, []) for group, own in divided]
    except StepInfeasible:
        return None
    optimum = joined_optimum(step, [group for group, _ in divided], optima)
    stored = ("delta_q", "net", "lam", "slack", "working_set")
    found = {name: getattr(optimum, name) for name in stored}
    form = exact_form(step)
    solution = rational_solution(form, found["working_set"])
    unit = form.x_unit / solution.denominator
    x = [Fraction(int(v.p), int(v.q)) for v in (unit * v for v in solution.x)]
    pairs = zip(x, found["delta_q"].tolist(), strict=True)
    found["rest"] = [float(v - Fraction(rounded)) for v, rounded in pairs]
    found["degeneracy"] = [[one.multipliers_unique, one.differentiable] for one in optima]
    return found


def test_known_steps_are_of_every_kind():
    steps = known_steps()
    outcomes = Counter("".join(known.outcomes for known in steps))
    assert min(outcomes["o"], outcomes["r"], outcomes["-"]) > 100
    assert sum(known.optimum is None for known in steps) > 5
    assert sum(len(group_steps(known.step)) > 1 for known in steps) > 50
    assert sum(bool(known.step.extra.names) for known in steps) > 50
    degenerate = [
        known for known in steps if known.optimum and [False, True] in known.optimum["degeneracy"]
    ]
    assert len(degenerate) > 5


def test_an_optimum_that_is_stored_is_that_of_the_exact_method():
    """Of a sample."""
    for known in known_steps()[::16]:
        assert json.loads(json_text(optimum_of(known.step))) == known.optimum


def test_as_many_digits_are_found_as_determinants_have():
    """The column of f is 2^416 times larger in whole numbers: p^m is above 2^416."""
    *_, step = small_numbers()
    first = next(tried(Known(step, optimum_of(step), "", [])))
    assert P**first.digits > 2**416
