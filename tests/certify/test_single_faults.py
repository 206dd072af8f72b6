"""`verify` on files with one fault."""

import pytest

from tests.helpers import verify_refusal
from tests.oracles.single_faults import PROVED, single_faults

FAULTS = list(single_faults())


@pytest.mark.parametrize(
    ("step", "solution", "reason"), FAULTS, ids=[f"{i} {why}" for i, (*_, why) in enumerate(FAULTS)]
)
def test_one_fault_is_enough_to_be_refused_and_a_rare_rounding_is_none(
    step, solution, reason, tmp_path
):
    assert (verify_refusal(tmp_path, step, solution) is None) == (reason == PROVED)
