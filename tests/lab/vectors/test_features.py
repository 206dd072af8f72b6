"""The features of the vectors' cases are counted, and the committed table has the counts."""

from quasistatic_ref.lab.vectors.features import FEW, features
from quasistatic_ref.lab.vectors.tables import follower, free_body, scene
from tests.lab.vectors.committed_cases import ROOT
from validation.make import vector_features

TABLE = ROOT / "validation" / "results" / "vector_features.csv"
THIN_BEFORE = {
    "selection": ("normals", "empty group", "k above the candidates"),
    "integrate": ("mimic with a factor", "mimic with an offset", "joint revolute of the world"),
    "jacobian": ("mimic with a factor", "mimic with an offset", "joint continuous of the world",
                 "joint revolute of a mimic with an offset"),
    "rows": ("cone product", "cone facets-4", "cone facets-6", "cone frictionless"),
    "wrench": ("cone product", "cone facets-8", "cone frictionless", "cone ellipsoid"),
    "step": ("springs coupled", "mimic with an offset", "cone product", "cone frictionless",
             "planar base actuated", "cone facets-8", "joint continuous of the world",
             "joint prismatic of the world", "joint revolute of a mimic with an offset",
             "no solution"),
}  # fmt: skip
"""Features of which version 6 or 7 had fewer than five cases."""


def test_features_of_a_case():
    bodies = [*follower("revolute"), {**free_body(), "com": [0.0, 0.1, 0.0]}]
    case = scene(bodies, {}, [0.0] * 8, pairs=[], K_q=[[2.0, 1.0], [1.0, 2.0]])
    found = features(case, {"farkas": [1.0], "contacts": [{"phi": -0.1, "n": [0.6, 0.0, 0.8]}]})
    assert found >= {"mimic with a factor", "mimic with an offset", "springs coupled",
                     "centre of mass off the origin", "no solution", "phi below 0",
                     "joint revolute of the world", "joint floating of the world"}  # fmt: skip
    assert "two least entries of n equal" not in found


def test_the_committed_table_is_that_of_the_vectors_and_what_was_thin_is_not():
    lines = [*vector_features.page()]
    assert lines == TABLE.read_text().splitlines()
    head, *rows = (line.split(",") for line in lines)
    counts = {row[0]: dict(zip(head[1:], row[1:], strict=True)) for row in rows}
    for layer, names in THIN_BEFORE.items():
        for name in names:
            assert int(counts[name][layer]) >= FEW, (layer, name)
