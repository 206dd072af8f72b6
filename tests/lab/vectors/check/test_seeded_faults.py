"""Mistakes planted in the plain program: each is caught, and the checker names it."""

import pytest

from quasistatic_ref.lab.vectors.check.case import case_verdict
from quasistatic_ref.lab.vectors.check.patched import patched_texts, program
from quasistatic_ref.lab.vectors.check.table import FACTOR
from quasistatic_ref.lab.vectors.check.table import PATCHES as TABLE
from quasistatic_ref.lab.vectors.check.verdict import FAILED
from tests.lab.vectors.committed_cases import (
    by_size,
    expected_of,
    report_on,
    right_answers,
    small_cases,
)

IMPOSSIBLE = (ArithmeticError, LookupError, TypeError, ValueError)
"""What a patched program raises in cases in which the mistake cannot be made."""
PATCHES = {
    f"{layer}: {name} {number}": (name, layer, patch.replace(FACTOR, "0.01"))
    for name, by_layer in TABLE.items()
    for layer, patches in by_layer.items()
    if layer != "derivative"  # test_derivative_layer.py has them
    for number, patch in enumerate(patches, start=1)
}
NAMED = {
    (name, layer): patch
    for name, layer, patch in reversed(PATCHES.values())
    if layer not in ("distance", "step")  # slower
}
"""The first patch of each mistake in each layer."""


ALIKE = ["spin sign", "spin rows exchanged"]
"""Of a wrench: what the second gives is what the first gives, in all small cases."""


def patched_answers(layer, asked, patch):
    """The answers of the plain program with a patch, case by case."""
    for case in asked:
        try:
            yield case, program(patch)(layer, case.input)
        except IMPOSSIBLE:
            continue


@pytest.mark.parametrize(("name", "layer", "patch"), PATCHES.values(), ids=PATCHES)
def test_a_patch_is_caught_by_the_expected_answers(name, layer, patch):
    assert any(
        case_verdict(layer, case.input, expected_of(layer)[case.id], output).verdict == FAILED
        for case, output in patched_answers(layer, by_size(layer), patch)
    )


@pytest.mark.parametrize(("name", "layer"), NAMED)
def test_a_patch_is_named(name, layer):
    asked = patched_answers(layer, small_cases(layer), NAMED[name, layer])
    report = report_on(layer, {case.id: output for case, output in asked})
    assert report.count("failed") > 0
    wanted = ALIKE if (name, layer) == ("spin rows exchanged", "wrench") else [name]
    assert [mistake.name for mistake in report.mistakes] == wanted


def test_a_patch_whose_line_is_not_in_the_program_is_refused():
    with pytest.raises(ValueError, match="'b = phi' stands 0 times"):
        patched_texts("rows.py:\n- b = phi\n+ b = -phi")


def test_answers_that_are_right_have_no_mistake():
    for layer in ("rows", "jacobian", "selection"):
        report = report_on(layer, right_answers(layer))
        assert report.ok
        assert report.mistakes == ()
