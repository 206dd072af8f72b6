"""`verify` of the package on the files with one fault that the second checker is tried on."""

import pytest

from tests.oracles.single_faults import PROVED, single_faults
from validation.tools.verifier_files import verify_refusal

FAULTS = list(single_faults())


@pytest.mark.parametrize(
    ("step", "solution", "reason"), FAULTS, ids=[f"{i} {why}" for i, (*_, why) in enumerate(FAULTS)]
)
def test_one_fault_is_enough_to_be_refused_and_a_rare_rounding_is_none(
    step, solution, reason, tmp_path
):
    files = tmp_path / "step.json", tmp_path / "solution.json"
    for path, text in zip(files, (step, solution), strict=True):
        path.write_text(text)
    assert (verify_refusal(*files) is None) == (reason == PROVED)
