"""``solve``: the solution file, the certificate in words, and delta_q in decimals."""

import json
from decimal import Decimal
from fractions import Fraction

import pytest

from quasistatic_ref import save_step
from tests.helpers import point_on_floor


@pytest.fixture
def falling(tmp_path):
    """A point mass of 0.3 kg in the air: delta_q = h^2 force / m."""
    return save_step(tmp_path / "step.json", point_on_floor(phi=1.0, force=(1.0, -0.7, 0.0)))


def decimals_of(text):
    return dict(line.split() for line in text.splitlines())


@pytest.mark.parametrize("digits", [1, 5, 30])
def test_decimals_are_those_of_the_exact_fraction(falling, cli, digits):
    said = decimals_of(cli("solve", falling, "--digits", digits).out)
    assert list(said) == ["delta_q_u[0]", "delta_q_u[1]", "delta_q_u[2]"]
    h = Fraction(0.01)
    m = Fraction(0.3)
    for text, force in zip(said.values(), (1.0, -0.7, 0.0), strict=True):
        exact = h * h * Fraction(force) / m
        assert len(text.lstrip("-").split("e")[0]) == digits + 1  # and a point
        last = Fraction(10) ** (Decimal(text).adjusted() - digits + 1)
        assert abs(Fraction(text) - exact) <= last / 2


def test_decimals_stand_alone_and_the_solution_goes_to_its_file(falling, cli, tmp_path):
    solution = tmp_path / "solution.json"
    printed = cli("solve", falling, "--digits", "20", "-o", solution)
    delta_q = json.loads(solution.read_text())["delta_q"]
    assert [float(text) for text in decimals_of(printed.out).values()] == delta_q
    assert printed.err.startswith("exact: the optimum of the step")


def test_without_decimals_standard_output_is_the_solution(falling, cli):
    assert json.loads(cli("solve", falling).out)["certificate"]["kind"] == "exact"


NO_DECIMALS = {"--digits 0": "at least 1", "--digits 30 --certify residual": "exact optimum"}


@pytest.mark.parametrize("options", NO_DECIMALS)
def test_decimals_that_do_not_exist_are_refused(falling, cli, options):
    printed = cli("solve", falling, options, status=2)
    assert NO_DECIMALS[options] in printed.err
    assert printed.out == ""
