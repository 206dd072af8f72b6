"""The package's own answers to every case."""

import numpy as np
import pytest

from quasistatic_ref.lab.vectors.own.system import own_system
from quasistatic_ref.lab.vectors.tables import link
from tests.cases import parts
from tests.closeness import assert_within
from tests.lab.vectors.committed_cases import NUMPY, cases, own_answer, report_on


@pytest.mark.parametrize("part", parts(5))
@pytest.mark.parametrize("name", NUMPY)
def test_the_package_meets_every_case(name, part):
    some = cases(name)[part::5]
    report = report_on(name, {case.id: own_answer(name, case.input) for case in some})
    assert report.ok, report.trouble


def test_the_package_undoes_its_own_step_to_the_last_digits(rng):
    # pinocchio alone loses 4e-4 of the translation at 1e-13 rad, and the angle below 1e-8.
    table = {"bodies": [link("base", None, "planar"), link("wheel", "base", "continuous")]}
    system = own_system(table).system
    for angle in (1e-15, 1e-13, 1e-9, 1e-5, 1e-3, 1.0, 3.0):
        q = np.array([*rng.normal(size=2), np.cos(0.3), np.sin(0.3), np.cos(2), np.sin(2)])
        step = np.array([*rng.normal(size=2), angle, -angle])
        back = system.difference(q, system.integrate(q, step))
        assert_within(back, step, 1e-14)
