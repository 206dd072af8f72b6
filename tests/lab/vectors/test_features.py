"""The features of the vectors' cases are counted, and the committed table has the counts."""

from itertools import product

from quasistatic_ref.lab.vectors.features import FEW, features
from quasistatic_ref.lab.vectors.tables import follower, free_body, scene
from tests.lab.vectors.committed_cases import ROOT
from validation.make import vector_features

TABLE = ROOT / "validation" / "results" / "vector_features.csv"
SOLIDS = ("box", "capsule", "cone", "convex", "cylinder", "ellipsoid", "sphere")
ALONE = {*product(("cone", "ellipsoid"), repeat=2), ("cloud", "cloud"), ("halfspace", "halfspace")}
"""Pairs of shapes that the layer `distance` refuses."""
PAIRS = {f"{a} on {b}" for a, b in {*product((*SOLIDS, "cloud", "halfspace"), repeat=2)} - ALONE}


def test_features_of_a_case():
    bodies = [*follower("revolute"), {**free_body(), "com": [0.0, 0.1, 0.0]}]
    case = scene(bodies, {}, [0.0] * 8, pairs=[], K_q=[[2.0, 1.0], [1.0, 2.0]])
    found = features(case, {"farkas": [1.0], "contacts": [{"phi": -0.1, "n": [0.6, 0.0, 0.8]}]})
    assert found >= {"mimic with a factor", "mimic with an offset", "springs coupled",
                     "centre of mass off the origin", "no solution", "phi below 0",
                     "joint revolute of the world", "joint floating of the world"}  # fmt: skip
    assert "two least entries of n equal" not in found


def test_the_committed_table_is_that_of_the_vectors_and_no_feature_is_thin():
    lines = [*vector_features.page()]
    assert lines == TABLE.read_text().splitlines()
    head, *rows = (line.split(",") for line in lines)
    counts = {row[0]: dict(zip(head[1:], map(int, row[1:]), strict=True)) for row in rows}
    assert {name for name in counts if " on " in name} == PAIRS
    for name, by_layer in counts.items():
        if name in PAIRS:  # a step and a derivative have the closest points of each pair once
            assert by_layer["distance"] >= FEW, name
        else:
            assert all(count == 0 or count >= FEW for count in by_layer.values()), name
