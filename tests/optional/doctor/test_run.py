"""Findings of what steps did not represent: what triggers each, and the near miss that does not."""

from types import SimpleNamespace

import numpy as np
import pytest

from quasistatic_ref import load_scenario, load_trajectory
from quasistatic_ref.formats.npz import json_array
from quasistatic_ref.optional.doctor.steps import sunk
from quasistatic_ref.simulate.header import header_table
from quasistatic_ref.tolerances import SUNK
from tests.scenes import written_scenario


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """A ball of radius 0.05 m, a floor, and a plate that slides along x from -1 m to 1 m."""
    return written_scenario(tmp_path_factory.mktemp("scene"))


def test_a_file_from_before_there_were_findings_has_none(scene, tmp_path):
    run = load_scenario(scene, fast=True).run(progress=False)
    header = header_table(run.header) | {"warnings": ["a sentence"]}
    del header["findings"]
    np.savez(tmp_path / "old.npz", header=json_array(header), **run.arrays)
    assert load_trajectory(tmp_path / "old.npz").findings == ()


class Made:
    """What `sunk` reads of a run, of which nothing is known but some arrays."""

    def __init__(self, pairs, **arrays):
        nothing = np.zeros_like(arrays["phi"])
        self.pairs = pairs
        self.system = SimpleNamespace(of_mjcf=False)
        self.arrays = {"point": nothing.astype(int), "gap": nothing} | arrays

    def __getitem__(self, name):
        return self.arrays[name]

    noted = __getitem__


def sentences(scenario, **arrays):
    return [said.sentence for said in sunk(Made(scenario.pairs, **arrays))]


@pytest.mark.parametrize(("share", "gap", "warned"), [
    (1.01, 0.0, True),  # deeper than a hundredth of the ball's diameter, and predicted to touch
    (0.99, 0.0, False),
    (1.01, -1.01 * SUNK * 0.1, False),  # as deep as the step before predicted
    (1.01, -0.02 * SUNK * 0.1, False),  # all but 0.99 of it was
])  # fmt: skip
def test_a_contact_that_sinks_unpredicted_needs_shorter_steps(scene, share, gap, warned):
    phi = np.zeros((3, 2))
    phi[2, 0] = -share * SUNK * 0.1
    said = sentences(load_scenario(scene, fast=True), phi=phi, gap=np.full((3, 2), gap))
    depth = share * SUNK * 100.0
    sentence = (
        "take a smaller h or move slower: candidate 0 of floor(floor, ball/ball#0) is "
        f"{depth:.3g} mm deep at step 2; the step before, which is right to first order, left it "
        "at 0 mm"
    )
    assert said == ([sentence] if warned else [])


def test_a_pair_of_solids_that_could_keep_more_contacts_is_asked_for_k(scene):
    # push: a box against a ball has 8 corners and the closest pair, of which one is kept.
    phi = np.zeros((3, 2))
    phi[1, 1] = -2 * SUNK * 0.1
    (said,) = sentences(load_scenario(scene, fast=True), phi=phi)
    assert said.startswith("take a smaller h or move slower, or raise k of contacts.push: ")
    # Two are kept: a corner that was not one of them is a contact that k left out.
    scenario = load_scenario(scene, ["contacts.push.k=2"], fast=True)
    phi = np.zeros((3, 3))
    point = np.array([[0, 8, 3], [0, 8, 3], [0, 5, 8]])
    phi[2, 1] = -2 * SUNK * 0.1
    (said,) = sentences(scenario, phi=phi, point=point)
    assert said == (
        "raise k of contacts.push: point 5 of push(rail/plate#0, ball/ball#0) was not among its 2 "
        "closest at step 1 and is 2 mm deep at step 2"
    )
