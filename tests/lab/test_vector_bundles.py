"""Quadratic programs in qpbenchmark's format."""

import sys

import numpy as np
import pytest
from pyarrow.parquet import read_table

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.parquet import Program, parquet_written

PROGRAMS = [
    Program(
        "two rows",
        H=np.array([[2.0, 1.0], [1.0, 3.0]]),
        g=np.array([1.0, 0.0]),
        A=np.array([[1.0, 2.0], [3.0, 4.0]]),
        b=np.array([-1.0, 0.0]),
        delta_q=np.array([0.5, -0.25]),
    ),
    Program("no rows", np.eye(3), np.arange(3.0), np.zeros((0, 3)), np.zeros(0)),
]


def test_parquet_holds_qpbenchmarks_columns_with_its_signs(tmp_path):
    # min 1/2 x'Px + q'x, Gx <= h against min 1/2 x'Hx - g'x, Ax >= b: q = -g, G = -A, h = -b.
    table = read_table(parquet_written(tmp_path / "qps.parquet", PROGRAMS))
    assert table.column_names == ["P", "q", "G", "h", "A", "b", "lb", "ub", "name"]
    first, second = table.to_pylist()
    assert first["P"] == [2.0, 1.0, 1.0, 3.0]
    assert str(first["q"]) == "[-1.0, 0.0]"
    assert first["G"] == [-1.0, -2.0, -3.0, -4.0]
    assert str(first["h"]) == "[1.0, 0.0]"
    assert [first[key] for key in ("A", "b", "lb", "ub")] == [None] * 4
    assert second["q"] == [0.0, -1.0, -2.0]
    assert (second["G"], second["h"]) == (None, None)
    assert [row["name"] for row in (first, second)] == ["two rows", "no rows"]


def test_without_pyarrow_the_extra_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(InputError, match=r"pip install 'quasistatic-ref\[parquet\]'"):
        parquet_written(tmp_path / "qps.parquet", PROGRAMS)
