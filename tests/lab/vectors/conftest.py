"""Answers to the vectors that the tests of the checker spoil."""

import pytest

from tests.lab.vectors.committed_cases import LIGHT, answer_file, right_answers


@pytest.fixture
def folder(tmp_path):
    """Right answers to three layers."""
    for layer in LIGHT:
        answer_file(tmp_path, layer, right_answers(layer))
    return tmp_path
