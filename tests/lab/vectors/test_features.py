"""The features of the vectors' cases are counted, and the committed page has the counts."""

from quasistatic_ref.lab.vectors.features import features
from quasistatic_ref.lab.vectors.tables import follower, free_body, scene
from tests.lab.vectors.material import ROOT
from validation.make import vector_features

PAGE = ROOT / "validation" / "results" / "vector_features.md"


def test_features_of_a_case():
    bodies = [*follower("revolute"), {**free_body(), "com": [0.0, 0.1, 0.0]}]
    case = scene(bodies, {}, [0.0] * 8, pairs=[], K_q=[[2.0, 1.0], [1.0, 2.0]])
    found = features(case, {"farkas": [1.0], "contacts": [{"phi": -0.1, "n": [0.6, 0.0, 0.8]}]})
    assert found >= {"mimic with a factor", "mimic with an offset", "springs coupled",
                     "centre of mass off the origin", "no solution", "phi below 0",
                     "joint revolute of the world", "joint floating of the world"}  # fmt: skip
    assert "two least entries of n equal" not in found


def test_the_committed_page_is_that_of_the_vectors():
    assert "\n".join(vector_features.page()).split() == PAGE.read_text().split()
