"""The comparison with MuJoCo: the formula of its contact point, and what its absence does."""

from quasistatic_ref.lab.claims import mujoco_rows
from quasistatic_ref.lab.claims.claim import FAILS, HOLDS, claim_result
from quasistatic_ref.lab.claims.mujoco_rows import rows_of


def test_without_the_formula_the_rows_do_not_agree(monkeypatch):
    def without(scene):
        rows = rows_of(scene)
        return rows | {"shift": 0 * rows["shift"]}

    assert claim_result(mujoco_rows.CLAIM).verdict == HOLDS
    monkeypatch.setattr(mujoco_rows, "rows_of", without)
    found = claim_result(mujoco_rows.CLAIM)
    assert found.verdict == FAILS
    # It is the tangential rows that suffer, and the torsional ones that do not.
    holds = {c.what.split()[0]: c.holds for c in found.comparisons}
    assert not holds["tangential"]
    assert holds["torsional"]
