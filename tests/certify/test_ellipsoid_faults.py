"""`verify` on files of answers in the ellipsoid with one fault."""

import pytest

from tests.helpers import verify_refusal
from tests.oracles.ellipsoid_faults import PROVED, ellipsoid_faults

FAULTS = list(ellipsoid_faults())


@pytest.mark.parametrize(
    ("step", "solution", "reason"), FAULTS, ids=[f"{i} {why}" for i, (*_, why) in enumerate(FAULTS)]
)
def test_one_fault_is_enough_to_be_refused_and_the_edge_of_friction_is_none(
    step, solution, reason, tmp_path
):
    assert (verify_refusal(tmp_path, step, solution) is None) == (reason == PROVED)
