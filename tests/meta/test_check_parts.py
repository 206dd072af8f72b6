"""The check that takes optional parts away: its table, and that it sees what is wrong."""

from types import SimpleNamespace

import numpy as np
import pytest

from tests.meta.layers import OPTIONAL, REMAINING
from validation.tools import check_parts

GAP = {"phi": np.zeros(3).tobytes()}


def test_every_part_that_the_core_does_not_import_is_in_the_table():
    core = {file: parts for file, parts in REMAINING.items() if not file.startswith("optional/")}
    imported = set().union(*core.values())
    named = {f"optional/{name}" for name in check_parts.PARTS}
    assert set(OPTIONAL) - imported <= named <= set(OPTIONAL)


@pytest.fixture
def ends(monkeypatch):
    """Have runs end with a status and a sentence, after they wrote phi = 0 of three contacts."""

    def ending(status, said):
        def ended(folder, steps, *options):
            assert not (folder / "quasistatic_ref" / "optional" / "runs").exists()
            assert (folder / "quasistatic_ref" / "optional" / "show").exists()
            np.savez(folder / f"{check_parts.SCENARIO}.npz", phi=np.zeros(3))
            return SimpleNamespace(returncode=status if options else 0, stderr=said)

        monkeypatch.setattr(check_parts, "ended", ended)

    return ending


def test_equal_bits_and_a_sentence_are_good(ends):
    ends(2, "quasistatic-ref: --resume needs quasistatic_ref/optional/runs\n")
    assert check_parts.faults(GAP, 1, "runs") == []


@pytest.mark.parametrize(
    ("status", "said", "expected", "fault"),
    [
        (0, "--resume needs quasistatic_ref/optional/runs", GAP, "--resume is not refused"),
        (2, "no such option", GAP, "--resume is not refused"),
        (2, "--resume needs quasistatic_ref/optional/runs", {"phi": b""}, "phi has other bits"),
    ],
)
def test_other_bits_and_other_words_are_faults(ends, status, said, expected, fault):
    ends(status, said)
    (found,) = check_parts.faults(expected, 1, "runs")
    assert found.startswith(fault)
