"""Headers of PLY and PCD files: their limits, and lines that are rarely there."""

import numpy as np
import pytest

from quasistatic_ref.errors import ModelError
from quasistatic_ref.optional.readers.pcd import pcd_points
from quasistatic_ref.optional.readers.ply import ply_points

POINTS = [[0.5, -0.25, 2.0], [1.0, 4.0, -8.0]]
LINES = "0.5 -0.25 2\n1 4 -8\n"
PCD = (
    "VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
    f"POINTS 2\nDATA ascii\n{LINES}"
)
PLY = (
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\n"
    f"property double z\nend_header\n{LINES}"
)


def replaced(text: str, old: str, new: str) -> bytes:
    assert text.count(old) == 1
    return text.replace(old, new).encode()


PCD_GOOD = {
    "as it is": ("VERSION", "VERSION"),
    "an empty line first": ("VERSION", "\nVERSION"),
    "no POINTS": ("POINTS 2\n", ""),
    "no WIDTH": ("WIDTH 2\n", ""),
    "no COUNT": ("COUNT 1 1 1\n", ""),
}


@pytest.mark.parametrize(("old", "new"), PCD_GOOD.values(), ids=PCD_GOOD)
def test_a_pcd_says_its_number_of_points_once_or_twice(old: str, new: str) -> None:
    assert pcd_points(replaced(PCD, old, new)).tolist() == POINTS


PCD_BAD = {
    "a line twice": ("SIZE 8 8 8\n", "SIZE 8 8 8\nSIZE 4 4 4\n", "line 4: must begin with one of"),
    "no value": ("WIDTH 2", "WIDTH", "WIDTH: must be a whole number"),
}


@pytest.mark.parametrize(("old", "new", "words"), PCD_BAD.values(), ids=PCD_BAD)
def test_a_pcd_with_a_bad_header_is_refused(old: str, new: str, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        pcd_points(replaced(PCD, old, new))


def test_properties_of_a_later_element_of_a_ply_are_no_columns() -> None:
    edge = "element edge 1\nproperty int a\nproperty int b\nend_header\n"
    found = ply_points(replaced(PLY, "end_header\n", edge) + b"0 1\n")
    np.testing.assert_array_equal(found, POINTS)


def test_a_property_of_a_ply_before_any_element_is_refused() -> None:
    with pytest.raises(ModelError, match="line 3: is not understood"):
        ply_points(replaced(PLY, "element", "property double w\nelement"))
