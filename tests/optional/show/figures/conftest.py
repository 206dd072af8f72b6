"""The run of the grasp that figures are drawn of."""

import pytest

from quasistatic_ref import load_scenario, trajectory_read


@pytest.fixture(scope="package")
def runs(demo):
    names = ("with_torsion", "without_torsion")
    return {n: trajectory_read(demo.folder / f"bunny_grasp_{n}.npz") for n in names}


@pytest.fixture(scope="package")
def grasp():
    return load_scenario("bunny_grasp", fast=True)
